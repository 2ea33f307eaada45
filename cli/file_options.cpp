#include "cli/file_options.h"

#include "cli/options.h"
#include "support/errors.h"

namespace clothbrdf {

std::string with_suffix(const std::string& name, const std::string& suffix) {
  const std::size_t ending = format_for(name).ending.size();
  return name.substr(0, name.size() - ending) + suffix + name.substr(name.size() - ending);
}

void add_file_options(CLI::App& command, FileOptions& options) {
  command.add_flag("--half", options.half,
                   "16-bit floats (EXR); a value that does not fit is an error");
  command.add_flag("--compress", options.compress, "compress without loss (EXR)");
  add_text_option(command, "--flavour", options.flavour, "WHICH",
                  "colours of .bsdf files: rgb (the default; Mitsuba's rgb variants, Falcor), "
                  "spectral (pbrt-v4, Mitsuba's spectral variants) or both, as two files with _rgb "
                  "and _spec before the ending");
  add_text_option(command, "--size", options.size, "BYTES",
                  "largest file, in bytes: more bytes, smaller error (formats that choose their "
                  "own nodes)");
}

std::vector<FileToWrite> files_to_write(const std::string& name, const FileOptions& options) {
  FileToWrite file{name, {.half = options.half, .compress = options.compress}};
  if (options.size) {
    file.options.bytes =
        static_cast<std::uint64_t>(parse_number("--size", *options.size, {1, 1e12, true}));
  }
  if (!options.flavour) return {file};
  const std::string& flavour = *options.flavour;
  if (flavour == "both") {
    FileToWrite rgb{with_suffix(name, "_rgb"), file.options};
    FileToWrite spectral{with_suffix(name, "_spec"), file.options};
    rgb.options.flavour = Flavour::kRgb;
    spectral.options.flavour = Flavour::kSpectral;
    return {rgb, spectral};
  }
  if (flavour != "rgb" && flavour != "spectral") {
    throw InputError("--flavour: '" + flavour + "' is not allowed: rgb, spectral or both");
  }
  file.options.flavour = flavour == "rgb" ? Flavour::kRgb : Flavour::kSpectral;
  return {file};
}

}  // namespace clothbrdf
