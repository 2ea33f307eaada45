#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

#include "formats/tensor_tree.h"
#include "formats/tensor_tree_xml.h"
#include "formats/tristimulus.h"
#include "formats/window_read.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr int kDepth = 6;
constexpr int kDigits = 7;
constexpr std::string_view kOptions[] = {"--size"};
// The seventh digit of Y, u' and v', times what the way to a saturated colour loses.
constexpr StoredPrecision kPrecision = {1e-5, 0x1p-149};

enum class Component { kVisible, kU, kV };

double component_of(const BoxTree::Box& box, Component component) {
  const Tristimulus xyz = to_tristimulus({box.mean[0], box.mean[1], box.mean[2]});
  const double sum = xyz.X + 15 * xyz.Y + 3 * xyz.Z;
  // Black is stored as a dark grey.
  const bool black = !(xyz.Y > 0 && sum > 0);
  switch (component) {
    case Component::kVisible: return black ? 0 : xyz.Y;
    case Component::kU: return black ? 4.0 / 19 : std::max(0.0, 4 * xyz.X / sum);
    case Component::kV: return black ? 9.0 / 19 : std::max(0.0, 9 * xyz.Y / sum);
  }
  return 0;
}

// What a tree would take, without writing it.
class ByteCount {
 public:
  void text(std::string_view text) { bytes_ += text.size(); }
  void number(double value, int digits) {
    char number[32];
    bytes_ += static_cast<std::uint64_t>(
        std::to_chars(number, std::end(number), value, std::chars_format::general, digits).ptr -
        number);
  }
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::uint64_t bytes_ = 0;
};

// A subtree as nested braces: {value}, {16 values} or {16 subtrees}. Values have the first axis
// slowest, subtrees the first axis fastest.
template <class Sink>
void put_tree(const std::vector<BoxTree::Box>& boxes, std::size_t at, Component component,
              Sink& sink) {
  constexpr std::size_t kChildren = 16;
  const auto value = [&](std::size_t box) {
    sink.text(" ");
    sink.number(component_of(boxes[box], component), kDigits);
  };
  sink.text("{");
  if (boxes[at].size == 1) {
    value(at);
  } else if (boxes[at].size == kChildren + 1) {
    for (std::size_t k = 0; k < kChildren; ++k) {
      const std::size_t child = (k & 1U) << 3U | (k & 2U) << 1U | (k & 4U) >> 1U | k >> 3U;
      value(at + 1 + child);
    }
  } else {
    sink.text("\n");
    std::size_t child = at + 1;
    for (std::size_t n = 0; n < kChildren; ++n) {
      put_tree(boxes, child, component, sink);
      child += boxes[child].size;
    }
  }
  sink.text("}\n");
}

std::uint64_t tree_bytes(const BoxTree& tree) {
  ByteCount count;
  for (const Component c : {Component::kVisible, Component::kU, Component::kV}) {
    put_tree(tree.boxes(), 0, c, count);
  }
  return count.bytes();
}

// The least error, to 1 %, whose file fits.
void prune_to(BoxTree& tree, std::uint64_t bytes) {
  double error = kTreeError;
  while (tree_bytes(tree) > bytes) {
    error *= 1.01;
    tree.prune(error);
  }
}

void write_tensor_tree(const Producer& producer, AtomicFile& file, const WriteOptions& options) {
  BoxTree tree = BoxTree::build(producer, options.workers, {.depth = kDepth, .error = kTreeError});
  // The least size is that of the XML around one box.
  if (options.bytes) prune_to(tree, *options.bytes - kLeastTreeBytes / 2);
  WindowWriter out(file, producer.spec(),
                   "<IncidentDataStructure>TensorTree4</IncidentDataStructure>\n");
  const std::pair<const char*, Component> spectra[] = {
      {"Visible", Component::kVisible}, {"CIE-u", Component::kU}, {"CIE-v", Component::kV}};
  for (const auto& [spectrum, component] : spectra) {
    out.begin_block(spectrum, "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n");
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
      .summary = "nested boxes down to 64x64x64x64, for Radiance",
      .options = kOptions,
      .default_samples = [](Reflectance, bool isotropic) -> Samples { return AnyPairs{isotropic}; },
      .colours = [](const WriteOptions&) { return Colours::kRgb; },
      .keeps_description = false,
      .averages = "detail within boxes: the mean over each",
      .precision = [](const WriteOptions&) { return kPrecision; },
      .check = check_tensor_tree,
      .layout = tensor_tree_layout,
      .write = write_tensor_tree,
      .read = read_window};
}

}  // namespace clothbrdf
