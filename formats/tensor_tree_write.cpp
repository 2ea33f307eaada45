#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "formats/tensor_tree.h"
#include "formats/tensor_tree_xml.h"
#include "formats/tristimulus.h"
#include "formats/window_read.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr int kDepth = 7;
constexpr int kDigits = 7;
// 160 MB while the tree is put together.
constexpr std::size_t kMostBoxes = 4000000;
// A part holds 16 times the mean at most, and differs from it by 15 times.
constexpr double kLargestError = 16;
constexpr std::string_view kTreeOptions[] = {"--size"};

enum class Component { kVisible, kU, kV };
constexpr Component kComponents[] = {Component::kVisible, Component::kU, Component::kV};
constexpr const char* kSpectra[] = {"Visible", "CIE-u", "CIE-v"};

double component_of(const BoxTree::Box& box, Component component) {
  const Tristimulus xyz = to_tristimulus({box.mean[0], box.mean[1], box.mean[2]});
  const double sum = xyz.x + 15 * xyz.y + 3 * xyz.z;
  // Black is stored as a dark grey.
  const bool black = !(xyz.y > 0 && sum > 0);
  switch (component) {
    case Component::kVisible: return black ? 0 : xyz.y;
    case Component::kU: return black ? 4.0 / 19 : std::max(0.0, 4 * xyz.x / sum);
    case Component::kV: return black ? 9.0 / 19 : std::max(0.0, 9 * xyz.y / sum);
  }
  return 0;
}

// A subtree as nested braces: {value}, {16 values} or {16 subtrees}. Values have the first axis
// slowest, subtrees the first axis fastest.
void put_tree(const std::vector<BoxTree::Box>& boxes, std::size_t at, Component component,
              WindowWriter& out) {
  constexpr std::size_t kChildren = 16;
  const auto value = [&](std::size_t box) {
    out.text(" ");
    out.text(NumberString(component_of(boxes[box], component), kDigits).view());
  };
  out.text("{");
  if (boxes[at].size == 1) {
    value(at);
  } else if (boxes[at].size == kChildren + 1) {
    for (std::size_t k = 0; k < kChildren; ++k) {
      const std::size_t child = (k & 1U) << 3U | (k & 2U) << 1U | (k & 4U) >> 1U | k >> 3U;
      value(at + 1 + child);
    }
  } else {
    out.text("\n");
    std::size_t child = at + 1;
    for (std::size_t n = 0; n < kChildren; ++n) {
      put_tree(boxes, child, component, out);
      child += boxes[child].size;
    }
  }
  out.text("}\n");
}

// How long the numbers of each box are, with the blanks before them.
std::vector<std::uint8_t> number_bytes(const BoxTree& tree) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(tree.boxes().size());
  for (const BoxTree::Box& box : tree.boxes()) {
    std::size_t sum = 0;
    for (const Component c : kComponents) {
      sum += 1 + NumberString(component_of(box, c), kDigits).view().size();
    }
    bytes.push_back(static_cast<std::uint8_t>(sum));
  }
  return bytes;
}

// Of all three trees, pruned to an error; as put_tree writes them.
std::uint64_t pruned_bytes(const std::vector<BoxTree::Box>& boxes,
                           const std::vector<std::uint8_t>& numbers, double error,
                           std::size_t at = 0) {
  constexpr std::uint64_t kBraces = 9;  // "{", "}" and a line's end, thrice
  const auto whole = [&](std::size_t box) {
    return boxes[box].size == 1 || boxes[box].error <= error;
  };
  if (whole(at)) return kBraces + numbers[at];
  std::uint64_t sum = 0;
  std::uint64_t of_values = 0;
  bool all_whole = true;
  for (std::size_t child = at + 1; child < at + boxes[at].size; child += boxes[child].size) {
    sum += pruned_bytes(boxes, numbers, error, child);
    of_values += numbers[child];
    all_whole = all_whole && whole(child);
  }
  return kBraces + (all_whole ? of_values : 3 + sum);
}

// To the least error whose file fits, to one part in a thousand.
void prune_to(BoxTree& tree, std::uint64_t bytes) {
  const std::vector<std::uint8_t> numbers = number_bytes(tree);
  const auto fits = [&](double error) {
    return pruned_bytes(tree.boxes(), numbers, error) <= bytes;
  };
  if (fits(tree.error())) return;
  double low = tree.error();
  double high = kLargestError;
  while (high > 1.001 * low) {
    const double middle = std::sqrt(low * high);
    (fits(middle) ? high : low) = middle;
  }
  tree.prune(high);
}

void write_tensor_tree(const Producer& producer, AtomicFile& file, const WriteOptions& options) {
  const std::uint64_t bytes = options.bytes.value_or(kTreeBytes);
  // The text of a box takes about 24 bytes: cut too finely first, then to what fits.
  const std::size_t boxes = std::min<std::uint64_t>(kMostBoxes, bytes / 12);
  BoxTree tree = BoxTree::build(producer, options.workers,
                                {.depth = kDepth, .error = kTreeError, .boxes = boxes});
  prune_to(tree, bytes - kLeastTreeBytes / 2);  // the rest is for the XML around the trees
  WindowWriter out(file, producer.spec(),
                   "<IncidentDataStructure>TensorTree4</IncidentDataStructure>\n");
  for (const Component component : kComponents) {
    out.begin_block(kSpectra[static_cast<std::size_t>(component)],
                    "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n");
    put_tree(tree.boxes(), 0, component, out);
    out.end_block();
  }
  out.finish();
}

void check_tensor_tree(const TableSpec& spec, const WriteOptions& options,
                       const std::string& name) {
  refuse_own_samples(spec, name, "a tensor tree has boxes of its own");
  if (options.bytes && *options.bytes < kLeastTreeBytes) {
    throw InputError(name + ": --size " + std::to_string(*options.bytes) +
                     " is too small for a tensor tree; allowed: from " +
                     std::to_string(kLeastTreeBytes));
  }
}

Layout tensor_tree_layout(const TableSpec& /*any*/, const WriteOptions& /*any*/) {
  const std::string size = std::to_string(1U << static_cast<unsigned>(kDepth));
  return {"boxes down to " + size + "x" + size + "x" + size + "x" + size,
          std::size_t{1} << (4U * static_cast<unsigned>(kDepth))};
}

}  // namespace

Format tensor_tree_format() {
  return {
      .name = "tensor tree",
      .ending = ".tree.xml",
      .summary = "nested boxes down to 128x128x128x128, for Radiance",
      .options = kTreeOptions,
      .default_samples = [](Reflectance, bool isotropic) -> Samples { return AnyPairs{isotropic}; },
      .colours = [](const WriteOptions&) { return Colours::kRgb; },
      .keeps_description = false,
      .averages = "detail within boxes: the mean over each",
      .precision = [](const WriteOptions&) { return kTensorTreePrecision; },
      .check = check_tensor_tree,
      .layout = tensor_tree_layout,
      .write = write_tensor_tree,
      .read = read_window};
}

}  // namespace clothbrdf
