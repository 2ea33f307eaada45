#include "formats/window_xml.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>
#include <system_error>

#include "formats/format.h"
#include "formats/json_text.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

bool blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

std::string_view word(const pugi::xml_node& parent, const char* child) {
  return without_blanks(parent.child_value(child));
}

std::string xml_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      // Control characters are not allowed in XML.
      default: result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return result;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string result = "'";
  for (const char c : text.substr(0, kMost)) {
    result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result + (text.size() > kMost ? "...'" : "'");
}

}  // namespace

bool same_word(std::string_view a, std::string_view b) {
  a = without_blanks(a);
  b = without_blanks(b);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

char NumberText::peek() {
  while (!rest_.empty() && blank(rest_.front())) rest_.remove_prefix(1);
  return rest_.empty() ? '\0' : rest_.front();
}

bool NumberText::take(char wanted) {
  if (peek() != wanted || rest_.empty()) return false;
  rest_.remove_prefix(1);
  return true;
}

std::optional<double> NumberText::number() {
  if (peek() == '+') rest_.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
  if (error == std::errc::invalid_argument) return std::nullopt;
  const auto length = static_cast<std::size_t>(end - rest_.data());
  if (error == std::errc::result_out_of_range) {
    // from_chars does not say whether it is too large or too small for a double.
    const std::string_view text = rest_.substr(0, length);
    const std::size_t exponent = text.find_first_of("eE");
    const bool small = exponent != std::string_view::npos && text.substr(exponent + 1, 1) == "-";
    value = small ? 0 : std::numeric_limits<double>::infinity();
    if (text.front() == '-') value = -value;
  }
  rest_.remove_prefix(length);
  take(',');
  return value;
}

std::string NumberText::next_words() {
  peek();
  return rest_.empty() ? "the end" : quoted(rest_.substr(0, 20));
}

NumberString::NumberString(double value) : end_(std::to_chars(text_, std::end(text_), value).ptr) {}

NumberString::NumberString(double value, int digits)
    : end_(std::to_chars(text_, std::end(text_), value, std::chars_format::general, digits).ptr) {}

WindowFile::WindowFile(const std::filesystem::path& path) : name_(path.string()) {
  require_readable(path);
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const std::streamoff bytes = in.tellg();
  if (bytes <= 0) refuse("the file is empty; an XML file of WINDOW or Radiance is needed");
  text_.resize(static_cast<std::size_t>(bytes));
  in.seekg(0);
  in.read(text_.data(), bytes);
  if (!in) refuse("cannot be read");
  // In place: names and numbers stay where they are.
  const pugi::xml_parse_result parsed =
      document_.load_buffer_inplace(text_.data(), text_.size(), pugi::parse_default);
  if (!parsed) {
    refuse("is no XML: " + std::string(parsed.description()) + " at byte " +
           std::to_string(parsed.offset));
  }
  const pugi::xml_node top = document_.child("WindowElement");
  if (!top) refuse("has no element WindowElement: no file of WINDOW or Radiance");
  if (top.child("FileType") && word(top, "FileType") != "BSDF") {
    refuse("FileType is " + quoted(word(top, "FileType")) + "; allowed: BSDF");
  }
  const pugi::xml_node layer = top.child("Optical").child("Layer");
  if (!layer) refuse("has no element Optical with a Layer");
  structure_ = word(layer.child("DataDefinition"), "IncidentDataStructure");
  if (structure_.empty()) refuse("has no IncidentDataStructure");
  bool other_side = false;
  for (const pugi::xml_node spectrum : layer.children("WavelengthData")) {
    for (const pugi::xml_node block : spectrum.children("WavelengthDataBlock")) {
      if (!same_word(word(block, "WavelengthDataDirection"), "Reflection Back")) {
        other_side = true;
        continue;
      }
      std::string key(word(spectrum, "Wavelength"));
      std::transform(key.begin(), key.end(), key.begin(), lower);
      blocks_[key] = {block.child_value("ScatteringData"), word(block, "ColumnAngleBasis"),
                      word(block, "RowAngleBasis"), word(block, "AngleBasis")};
    }
  }
  if (find("Visible") == nullptr) {
    refuse(
        std::string("has no WavelengthDataBlock of Visible light and 'Reflection Back', which is "
                    "the cloth's front") +
        (other_side ? "; other directions are not read" : ""));
  }
}

const ScatteringBlock* WindowFile::find(std::string_view spectrum) const {
  std::string key(spectrum);
  std::transform(key.begin(), key.end(), key.begin(), lower);
  const auto found = blocks_.find(key);
  return found == blocks_.end() ? nullptr : &found->second;
}

void WindowFile::refuse(const std::string& what) const {
  throw InputError(name_ + ": " + one_line(what, 300));
}

WindowWriter::WindowWriter(AtomicFile& file, const TableSpec& spec, std::string_view definition)
    : file_(file) {
  buffer_.reserve(kBufferBytes);
  const std::optional<Material>& material = spec.provenance.material;
  const std::string name = material ? material->name : "";
  text(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<WindowElement xmlns=\"http://windows.lbl.gov\" "
      "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://windows.lbl.gov/BSDF-v1.4.xsd\">\n"
      "<WindowElementType>System</WindowElementType>\n"
      "<FileType>BSDF</FileType>\n"
      "<Optical>\n"
      "<Layer>\n"
      "<Material>\n<Name>");
  text(xml_text(name.empty() ? "cloth" : name));
  text("</Name>\n<Manufacturer>");
  text(xml_text(spec.provenance.program.empty() ? "unknown" : spec.provenance.program));
  text("</Manufacturer>\n<DeviceType>Other</DeviceType>\n</Material>\n<DataDefinition>\n");
  text(definition);
  text("</DataDefinition>\n");
}

void WindowWriter::begin_block(std::string_view spectrum, std::string_view bases) {
  text("<WavelengthData>\n<LayerNumber>System</LayerNumber>\n<Wavelength unit=\"Integral\">");
  text(spectrum);
  text(
      "</Wavelength>\n<SourceSpectrum>CIE Illuminant D65 1nm.ssp</SourceSpectrum>\n"
      "<DetectorSpectrum>");
  text(spectrum == "CIE-X"   ? "ASTM E308 1931 X.dsp"
       : spectrum == "CIE-Z" ? "ASTM E308 1931 Z.dsp"
                             : "ASTM E308 1931 Y.dsp");
  text(
      "</DetectorSpectrum>\n<WavelengthDataBlock>\n"
      "<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n");
  text(bases);
  text("<ScatteringDataType>BRDF</ScatteringDataType>\n<ScatteringData>\n");
}

void WindowWriter::end_block() {
  text("</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>\n");
}

void WindowWriter::text(std::string_view text) {
  if (buffer_.size() + text.size() > kBufferBytes) flush();
  buffer_ += text;
}

// No line's end at the last: every byte counts, and a file cut off is found out.
void WindowWriter::finish() {
  text("</Layer>\n</Optical>\n</WindowElement>");
  flush();
}

void WindowWriter::flush() {
  file_.write_at(written_, std::as_bytes(std::span(buffer_)));
  written_ += buffer_.size();
  buffer_.clear();
}

}  // namespace clothbrdf
