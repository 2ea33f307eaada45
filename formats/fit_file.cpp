#include "formats/fit_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "formats/fit_names.h"
#include "formats/json_text.h"
#include "formats/material_json.h"
#include "formats/schema_check.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using nlohmann::json;

class FitFileReader {
 public:
  FitFileReader(const json& file, std::string name, std::filesystem::path folder)
      : file_(file),
        name_(one_line(name, kLongestFileName)),
        full_name_(std::move(name)),
        folder_(std::move(folder)) {}

  FitOptions read() const {
    FitOptions options;
    if (const auto found = file_.find("parameters"); found != file_.end()) {
      options.wishes = read_wishes(*found);
    }
    if (const auto found = file_.find("start"); found != file_.end()) {
      options.start = read_start(*found);
    }
    if (const auto found = file_.find("layers"); found != file_.end()) {
      options.fewest_layers = (*found)[0].get<int>();
      options.most_layers = (*found)[1].get<int>();
      if (options.fewest_layers > options.most_layers) {
        fail("/layers", *found, "the fewest, then the most");
      }
    }
    read_set("reflectance", kReflectanceNames, options.reflectances);
    read_set("paths", kPathsNames, options.paths);
    read_choice("weighting", kWeightingNames, options.weighting);
    read_choice("loss", kLossNames, options.loss);
    if (const auto found = file_.find("noise"); found != file_.end()) {
      options.noise = found->get<double>();
    }
    options.starts = file_.value("starts", options.starts);
    options.seed = file_.value("seed", options.seed);
    return options;
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const json& value,
                         const std::string& allowed) const {
    throw InputError(name_ + ": " + pointer + ": " + one_line(value.dump()) +
                     " is not allowed: " + allowed);
  }

  // The schema has refused unknown names.
  template <class T, std::size_t N>
  void read_choice(const char* key, const ChoiceName<T> (&names)[N], T& value) const {
    const auto found = file_.find(key);
    if (found != file_.end()) value = *find_choice(names, found->get_ref<const std::string&>());
  }

  template <class T, std::size_t N>
  void read_set(const char* key, const ChoiceName<T> (&names)[N], std::vector<T>& values) const {
    const auto found = file_.find(key);
    if (found == file_.end() || *found == kBoth) return;  // both is the default
    values = {*find_choice(names, found->get_ref<const std::string&>())};
  }

  Material read_start(const json& start) const {
    if (start.is_object()) return parse_material(start.dump(), full_name_ + ": /start");
    return read_material(folder_ / start.get<std::string>());
  }

  std::vector<ParameterWish> read_wishes(const json& parameters) const {
    std::vector<std::string> names;
    for (const auto& [name, wish] : parameters.items()) names.push_back(name);
    // json keeps keys in alphabetical order: "absorption" before "warp", which wins as the later.
    std::stable_sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
      return std::count(a.begin(), a.end(), '.') < std::count(b.begin(), b.end(), '.');
    });
    std::vector<ParameterWish> wishes;
    for (const std::string& name : names) add_wishes(name, parameters.at(name), wishes);
    return wishes;
  }

  void add_wishes(const std::string& name, const json& wish,
                  std::vector<ParameterWish>& wishes) const {
    using Kind = ParameterWish::Kind;
    const std::string pointer = "/parameters" + pointer_step(name);
    if (wish.empty() ||
        (wish.size() > 1 && !(wish.size() == 2 && wish.contains("free") && wish.contains("start"))))
      fail(pointer, wish, "one of fix, free, start and tie, or free with start");
    if (const auto fix = wish.find("fix"); fix != wish.end()) {
      wishes.push_back({Kind::kFix, name, {}, {}, {}});
      if (fix->is_number()) wishes.back().value = fix->get<double>();
    }
    if (const auto free = wish.find("free"); free != wish.end()) {
      wishes.push_back({Kind::kFree, name, {}, {}, {}});
      if (free->is_array()) {
        wishes.back().lowest = (*free)[0].get<double>();
        wishes.back().highest = (*free)[1].get<double>();
        if (!(*wishes.back().lowest < *wishes.back().highest)) {
          fail(pointer + "/free", *free, "the lowest value, then a higher one");
        }
      }
    }
    if (const auto start = wish.find("start"); start != wish.end()) {
      wishes.push_back({Kind::kStart, name, start->get<double>(), {}, {}});
    }
    if (wish.contains("tie")) wishes.push_back({Kind::kTie, name, {}, {}, {}});
  }

  const json& file_;
  std::string name_;
  std::string full_name_;
  std::filesystem::path folder_;
};

}  // namespace

FitOptions read_fit_file(const std::filesystem::path& path) {
  return parse_fit_file(read_json_file(path), path.string(), path.parent_path());
}

FitOptions parse_fit_file(std::string_view text, const std::string& name,
                          const std::filesystem::path& folder) {
  const json file = parse_json(text, name);
  check_against_schema(file, "fit.schema.json", name);
  return FitFileReader(file, name, folder).read();
}

}  // namespace clothbrdf
