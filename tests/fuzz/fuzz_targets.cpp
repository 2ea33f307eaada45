#include "tests/fuzz/fuzz_targets.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iomanip>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "formats/fit_file.h"
#include "formats/format.h"
#include "formats/material_json.h"
#include "formats/plan_json.h"
#include "formats/scene_json.h"
#include "support/errors.h"
#include "table/grid.h"
#include "tests/support/make_table.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

[[noreturn]] void find(const std::string& what) { throw std::logic_error(what); }

std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// A file in memory that can be opened by its name.
class MemoryFile {
 public:
  explicit MemoryFile(Bytes bytes) : fd_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    if (fd_ < 0 || ::write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
      throw std::runtime_error("cannot make a file in memory");
    }
  }
  ~MemoryFile() { ::close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

// What work(name) returns; nothing where it refuses its input, in one line about that name.
template <class Work>
auto unless_refused(const std::string& name, const Work& work) -> std::optional<decltype(work())> {
  std::string line;
  try {
    return work();
  } catch (const InputError& error) {
    line = error.what();
  } catch (const WorkError& error) {
    line = error.what();
  }
  if (!line.starts_with(name + ":")) find("refused without the file's name: " + line);
  if (line.find('\n') != std::string::npos) find("refused in lines: " + line);
  return {};
}

// Numbers, drawn from the bytes as long as there are any.
class Drawn {
 public:
  explicit Drawn(Bytes bytes) : left_(bytes) {}

  template <class T>
  T next() {
    T value{};
    const std::size_t size = std::min(sizeof value, left_.size());
    if (size > 0) std::memcpy(&value, left_.data(), size);
    left_ = left_.subspan(size);
    return value;
  }
  int integer(int low, int high) { return low + next<std::uint8_t>() % (high - low + 1); }
  bool flag() { return next<std::uint8_t>() % 2 == 1; }
  bool empty() const { return left_.empty(); }

 private:
  Bytes left_;
};

WriteOptions drawn_options(const Format& format, Drawn& draw) {
  WriteOptions options;
  for (const std::string_view option : format.options) {
    if (option == "--half") options.half = draw.flag();
    if (option == "--compress") options.compress = draw.flag();
    if (option == "--flavour" && draw.flag()) options.flavour = Flavour::kRgb;
    if (option == "--size") options.bytes = std::uint64_t{draw.next<std::uint16_t>()} * 4;
  }
  return options;
}

Grid drawn_grid(Drawn& draw) {
  const int a = draw.integer(1, 4);
  const int b = draw.integer(1, 4);
  const int c = draw.integer(1, 4);
  const int d = draw.integer(1, 4);
  const double end = draw.flag() ? 180 : 360;
  switch (draw.integer(0, 2)) {
    case 0: return halfdiff3d(a, b, c, end);
    case 1: return halfdiff4d(a, b, c, d);
    default: return inout(a, b, c, d);
  }
}

// Values of all sizes; as most writers' tables, finite and not negative.
Table drawn_table(const TableSpec& spec, Drawn& draw) {
  std::vector<double> drawn;
  while (!draw.empty() && drawn.size() < spec.cell_count() * 3) {
    const double value = std::abs(draw.next<double>());
    drawn.push_back(std::isfinite(value) ? value : 0);
  }
  drawn.resize(std::max<std::size_t>(drawn.size(), 1));
  const std::vector<std::uint8_t> valid = cells_with_values(spec);
  std::vector<double> values(spec.cell_count() * 3);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = drawn[k % drawn.size()];
  const std::size_t columns = spec.column_count();
  for (std::size_t cell = 0; cell < valid.size(); ++cell) {
    if (valid[cell] != 0) continue;
    const std::size_t row = cell / columns;
    for (std::size_t c = 0; c < 3; ++c)
      values[row * spec.row_values() + c * columns + cell % columns] = 0;
  }
  return {spec, std::move(values), valid};
}

Samples own_samples_of(const Format& format) {
  return format.default_samples(Reflectance::kMicrofacet, false);
}

// The samples of a small grid, or those that the format always has.
std::optional<TableSpec> writable_spec(const Format& format, const WriteOptions& options,
                                       Drawn& draw) {
  TableSpec spec{drawn_grid(draw), rgb_channels(), {}, {}};
  const auto allowed = [&] {
    check_output(format, spec, options, "t");
    return true;
  };
  if (unless_refused("t", allowed)) return spec;
  spec.samples = own_samples_of(format);
  if (!spec.has_grid() || !unless_refused("t", allowed)) return {};
  return spec;
}

constexpr double kSmallest = 1e-290;

void check_same(const Table& written, const Table& read, const StoredPrecision& precision) {
  if (read.spec().cell_count() != written.spec().cell_count()) find("other cells are read back");
  for (std::size_t cell = 0; cell < written.spec().cell_count(); ++cell) {
    if (!written.valid(cell)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = written.value(cell, c);
      // Reading can round once more; parts of what is smaller can be subnormal.
      const double allowed = 2 * precision.relative * value + precision.step + kSmallest;
      if (!(std::abs(read.value(cell, c) - value) <= allowed)) {
        std::ostringstream text;
        text << "cell " << cell << ", channel " << c << ": wrote " << std::setprecision(17) << value
             << ", read " << read.value(cell, c);
        find(text.str());
      }
    }
  }
}

void round_trip(const Format& format, Bytes bytes) {
  static const TemporaryFolder kFolder;
  Drawn draw(bytes);
  const WriteOptions options = drawn_options(format, draw);
  const std::optional<TableSpec> spec = writable_spec(format, options, draw);
  if (!spec) return;
  const Table table = drawn_table(*spec, draw);
  AtomicFile file(kFolder / ("t" + std::string(format.ending)));
  const auto write = [&] {
    clothbrdf::write_table(format, table, file, options);
    return true;
  };
  if (!unless_refused(file.name().string(), write)) return;
  const Table read = format.read(file.readable());
  const bool own_nodes = std::holds_alternative<AnyPairs>(own_samples_of(format));
  if (!own_nodes) check_same(table, read, format.precision(options));
}

constexpr std::size_t kLargestSeed = 400000;  // bytes; of MERL's files the head is tried

FuzzTarget table_reader(const Format& format) {
  const auto run = [&format](Bytes bytes) {
    const MemoryFile file(bytes);
    unless_refused(file.path(), [&] { return format.read(file.path()); });
  };
  const auto seeds = [&format] {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / ("t" + std::string(format.ending));
    WriteOptions options;
    if (std::find(format.options.begin(), format.options.end(), "--size") != format.options.end()) {
      options.bytes = 80000;
    }
    Material material = read_material(preset("silk"));
    material.weights = {1, 0, 0};  // the others take formats of means their time
    TableSpec spec = material_spec(material, {}, halfdiff3d(3, 3, 4));
    const auto write = [&] {
      write_table(*make_producer(spec, 1), path, options);
      return true;
    };
    if (!unless_refused(path.string(), write)) {
      spec.samples = own_samples_of(format);
      if (!unless_refused(path.string(), write)) find("no seed of " + std::string(format.ending));
    }
    return std::vector{read_file(path).substr(0, kLargestSeed)};
  };
  return {"read" + std::string(format.ending), run, seeds};
}

FuzzTarget table_round_trip(const Format& format) {
  const auto seeds = [] {
    std::vector<std::string> all;
    for (int k = 0; k < 8; ++k) {
      std::string seed;
      for (int n = 0; n < 200; ++n) seed += static_cast<char>(n * (2 * k + 1) % 256);
      all.push_back(seed);
    }
    return all;
  };
  return {"write" + std::string(format.ending),
          [&format](Bytes bytes) { round_trip(format, bytes); }, seeds};
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(read_file(entry.path()));
  }
  return files;
}

const std::filesystem::path kSource = CLOTHBRDF_SOURCE_DIR;
const std::string kName = "any.json";
constexpr const char* kFitFile = R"({"loss": "huber", "starts": 3, "layers": [0, 4],
  "noise": 0.01, "weighting": "relative", "seed": 7, "reflectance": "both", "paths": "all",
  "parameters": {"warp.scatter": {"fix": 0.5}, "weft": {"tie": true}, "absorption": {"free": [0, 2]},
                 "layers": {"start": 3}}})";

std::vector<FuzzTarget> json_readers() {
  const auto material = [](Bytes bytes) {
    const auto read = [&] { return parse_material(text_of(bytes), kName); };
    const std::optional<Material> found = unless_refused(kName, read);
    if (found && parse_material(material_to_json(*found), kName) != *found)
      find("another material");
  };
  const auto scene = [](Bytes bytes) {
    unless_refused(kName, [&] { return parse_scene(text_of(bytes), kName, "/nowhere"); });
  };
  const auto plan = [](Bytes bytes) {
    const auto read = [&] { return parse_plan(text_of(bytes), kName); };
    const std::optional<Plan> found = unless_refused(kName, read);
    if (!found) return;
    const std::string text = plan_to_json(*found);
    if (plan_to_json(parse_plan(text, kName)) != text) find("another plan");
  };
  const auto fit = [](Bytes bytes) {
    unless_refused(kName, [&] { return parse_fit_file(text_of(bytes), kName, "/nowhere"); });
  };
  const auto materials = [] { return files_in(kSource / "materials"); };
  const auto scenes = [] { return files_in(kSource / "examples/scenes"); };
  const auto plans = [] {
    MaterialPlan silk;
    silk.material = read_material(preset("silk"));
    silk.effects.layers = 2;
    silk.kept = {"specular", "internal:2", "interreflection"};
    silk.left_out = {{"internal:2", "layers 3 to 4", 0.001}};
    silk.bound = 0.001;
    silk.brightest = 12;
    Plan plan{"silk", 0.005, 12, 12, 0.001, {silk}, {}};
    plan.reach.lights = {{{0, 60}, {-30.5, 40}}};
    plan.reach.eyes = {{{0, 10}, {0, 360}}};
    plan.reach.rotations_deg = {0, 45};
    return std::vector{plan_to_json(plan)};
  };
  const auto fits = [] { return std::vector<std::string>{kFitFile}; };
  return {{"material", material, materials},
          {"scene", scene, scenes},
          {"plan", plan, plans},
          {"fit", fit, fits}};
}

}  // namespace

std::vector<FuzzTarget> fuzz_targets() {
  std::vector<FuzzTarget> all = json_readers();
  for (const Format& format : formats()) {
    all.push_back(table_reader(format));
    all.push_back(table_round_trip(format));
  }
  return all;
}

}  // namespace clothbrdf::test
