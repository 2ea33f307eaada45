#include "formats/format.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>

#include "formats/alta.h"
#include "formats/exr.h"
#include "formats/format_colours.h"
#include "formats/klems.h"
#include "formats/mdl.h"
#include "formats/merl.h"
#include "formats/rgl.h"
#include "formats/tensor_tree_xml.h"
#include "formats/utia.h"
#include "support/errors.h"

namespace clothbrdf {

std::span<const Format> formats() {
  static const Format kFormats[] = {
      merl_format(), exr_format(),  rgl_format(),         utia_format(),  linear_utia_format(),
      mdl_format(),  alta_format(), alta_binary_format(), klems_format(), tensor_tree_format()};
  return kFormats;
}

std::vector<std::string_view> WriteOptions::given() const {
  std::vector<std::string_view> names;
  if (half) names.emplace_back("--half");
  if (compress) names.emplace_back("--compress");
  if (flavour) names.emplace_back("--flavour");
  if (bytes) names.emplace_back("--size");
  return names;
}

void check_output(const Format& format, const TableSpec& spec, const WriteOptions& options,
                  const std::string& name) {
  for (const std::string_view option : options.given()) {
    if (std::find(format.options.begin(), format.options.end(), option) == format.options.end()) {
      throw InputError(name + ": " + std::string(option) +
                       " is not allowed: " + std::string(format.name) + " has no such choice");
    }
  }
  check_colours(format, spec, options, name);
  format.check(spec, options, name);
}

void write_table(const Format& format, const Producer& producer, AtomicFile& file,
                 const WriteOptions& options) {
  check_output(format, producer.spec(), options, file.name().string());
  format.write(producer, file, options);
}

Layout own_samples(const TableSpec& spec, const WriteOptions& /*options*/) {
  return {spec.description(), spec.cell_count()};
}

void require_readable(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::string name = path.string();
  if (!std::filesystem::exists(path, ignored)) throw InputError(name + ": there is no such file");
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw InputError(name + ": is no regular file; a table is needed");
  }
  if (::access(path.c_str(), R_OK) != 0) {
    throw InputError(name + ": cannot be read: " + std::strerror(errno));
  }
}

const Format* find_format(const std::filesystem::path& path) {
  std::string file = path.filename().string();
  std::transform(file.begin(), file.end(), file.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const Format* found = nullptr;
  for (const Format& format : formats()) {
    if (file.size() <= format.ending.size() || !file.ends_with(format.ending)) continue;
    if (found == nullptr || format.ending.size() > found->ending.size()) found = &format;
  }
  return found;
}

const Format& format_for(const std::filesystem::path& path) {
  if (const Format* format = find_format(path)) return *format;
  std::string known;
  for (const Format& format : formats()) {
    known += (known.empty() ? "" : ", ") + std::string(format.ending) + " (" +
             std::string(format.name) + ")";
  }
  throw InputError(path.string() + ": the ending '" + path.extension().string() +
                   "' is not that of a table; known: " + known);
}

}  // namespace clothbrdf
