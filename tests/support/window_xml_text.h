#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/catch.h"

namespace clothbrdf::test {

/// The text between the first two marks after `from`; fails where there are none.
inline std::string between(const std::string& text, const std::string& first,
                           const std::string& last, std::size_t from = 0) {
  const std::size_t begin = text.find(first, from);
  REQUIRE(begin != std::string::npos);
  const std::size_t end = text.find(last, begin + first.size());
  REQUIRE(end != std::string::npos);
  return text.substr(begin + first.size(), end - begin - first.size());
}

/// The numbers' text of the reflection at Radiance's front, of one spectrum.
inline std::string scattering_text(const std::string& file, const std::string& spectrum) {
  const std::size_t at = file.find("<Wavelength unit=\"Integral\">" + spectrum + "</Wavelength>");
  REQUIRE(at != std::string::npos);
  CHECK(between(file, "<WavelengthDataDirection>", "</WavelengthDataDirection>", at) ==
        "Reflection Back");
  return between(file, "<ScatteringData>", "</ScatteringData>", at);
}

/// Numbers that commas and blanks separate.
inline std::vector<double> listed_numbers(std::string text) {
  for (char& c : text) c = c == ',' ? ' ' : c;
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (char* end = nullptr;; at = end) {
    const double number = std::strtod(at, &end);
    if (end == at) break;
    numbers.push_back(number);
  }
  CHECK(std::string(at).find_first_not_of(" \n\t\r") == std::string::npos);
  return numbers;
}

/// A small file of one spectrum, Visible.
inline std::string window_file(const std::string& structure, const std::string& bases,
                               const std::string& numbers) {
  return "<?xml version=\"1.0\"?><WindowElement><FileType>BSDF</FileType><Optical><Layer>"
         "<DataDefinition><IncidentDataStructure>" +
         structure +
         "</IncidentDataStructure></DataDefinition><WavelengthData>"
         "<Wavelength unit=\"Integral\">Visible</Wavelength><WavelengthDataBlock>"
         "<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>" +
         bases + "<ScatteringData>" + numbers +
         "</ScatteringData></WavelengthDataBlock></WavelengthData></Layer></Optical>"
         "</WindowElement>";
}

}  // namespace clothbrdf::test
