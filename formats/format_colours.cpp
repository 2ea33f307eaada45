#include "formats/format_colours.h"

#include <algorithm>
#include <vector>

#include "support/errors.h"
#include "table/mixed_channels.h"

namespace clothbrdf {
namespace {

bool is_mono(const TableSpec& spec) {
  return spec.channels.size() == 1 && spec.channels[0].name == kMono;
}

bool only_totals(const TableSpec& spec) {
  return std::all_of(spec.channels.begin(), spec.channels.end(),
                     [](const Channel& channel) { return channel.part == Part::kTotal; });
}

// In the order and number that formats write.
bool holds(const TableSpec& spec, Colours wanted) {
  if (wanted == Colours::kAny) return true;
  if (!only_totals(spec)) return false;
  if (wanted == Colours::kSpectrum) return has_wavelengths(spec);
  return has_rgb(spec) && spec.channels[0].name == "R" && spec.channels[1].name == "G";
}

std::unique_ptr<Producer> mono_to_rgb(const Producer& producer) {
  return std::make_unique<MixedChannels>(producer, std::vector<std::string>{"R", "G", "B"},
                                         std::vector<std::size_t>{0}, ChannelMatrix{{1}, {1}, {1}});
}

// Knows its spec, and no value.
class SpecOnly final : public Producer {
 public:
  explicit SpecOnly(const TableSpec& spec) : spec_(spec) {}
  const TableSpec& spec() const override { return spec_; }
  void fill_rows(std::size_t /*none*/, std::span<double> /*none*/) const override {}
  void fill_pairs(std::span<const Directions> /*none*/, std::span<double> /*none*/) const override {
  }

 private:
  const TableSpec& spec_;
};

}  // namespace

std::unique_ptr<Producer> in_colours_of(const Format& format, const Producer& producer,
                                        const WriteOptions& options) {
  const TableSpec& spec = producer.spec();
  const Colours wanted = format.colours(options);
  if (holds(spec, wanted)) return nullptr;
  if (wanted == Colours::kRgb && is_mono(spec)) return mono_to_rgb(producer);
  if (wanted == Colours::kRgb && has_wavelengths(spec)) return to_rgb(producer);
  if (wanted == Colours::kSpectrum && has_rgb(spec)) return to_spectrum(producer);
  return nullptr;
}

TableSpec in_colours_of(const Format& format, const TableSpec& spec, const WriteOptions& options) {
  const std::unique_ptr<Producer> mixed = in_colours_of(format, SpecOnly(spec), options);
  return mixed ? mixed->spec() : spec;
}

std::string colours_note(const TableSpec& source, const TableSpec& written) {
  if (source.channels == written.channels) return "";
  if (is_mono(source)) return "one channel stands for R, G and B";
  if (has_rgb(written) && has_wavelengths(source)) {
    return "the wavelengths: R, G and B as seen under D65";
  }
  if (has_wavelengths(written) && has_rgb(source)) {
    return "R, G and B as the smoothest spectrum that gives them back under D65";
  }
  return "";
}

void check_colours(const Format& format, const TableSpec& spec, const WriteOptions& options,
                   const std::string& name) {
  const Colours wanted = format.colours(options);
  if (holds(spec, wanted)) return;
  throw InputError(
      name + ": " + std::to_string(spec.channels.size()) + " channels (" +
      full_name(spec.channels.front()) + " ... " + full_name(spec.channels.back()) +
      ") are not allowed: " + std::string(format.name) +
      (wanted == Colours::kRgb ? " holds R, G and B only" : " holds wavelengths only"));
}

}  // namespace clothbrdf
