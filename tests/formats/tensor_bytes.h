#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace clothbrdf::test {

/// A field of a tensor file as bytes; written from the format's description, not by the code under
/// test.
struct TensorBytes {
  std::string name;
  int type;  // 1 u8, 10 f32, 11 f64
  std::vector<std::uint64_t> shape;
  std::string values;
};

template <class T>
TensorBytes tensor_of(const std::string& name, int type, std::vector<std::uint64_t> shape,
                      const std::vector<T>& values) {
  return {name, type, std::move(shape),
          std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T))};
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// How long the head of a file is.
inline std::size_t header_size(const std::vector<TensorBytes>& fields) {
  std::size_t size = 18;
  for (const TensorBytes& f : fields) size += 13 + f.name.size() + 8 * f.shape.size();
  return size;
}

inline std::string tensor_file(const std::vector<TensorBytes>& fields) {
  std::string head("tensor_file\0\1\0", 14);
  append(head, static_cast<std::uint32_t>(fields.size()));
  const std::size_t start = header_size(fields);
  std::string payload;
  for (const TensorBytes& f : fields) {
    while ((start + payload.size()) % 8 != 0) payload += '\0';
    append(head, static_cast<std::uint16_t>(f.name.size()));
    head += f.name;
    append(head, static_cast<std::uint16_t>(f.shape.size()));
    append(head, static_cast<std::uint8_t>(f.type));
    append(head, static_cast<std::uint64_t>(start + payload.size()));
    for (const std::uint64_t size : f.shape) append(head, size);
    payload += f.values;
  }
  return head + payload;
}

/// The fields of a file by name. Throws std::runtime_error where anything differs from what every
/// known reader takes: magic, version 1.0, types, values in order at multiples of 8, nothing else.
inline std::map<std::string, TensorBytes> strict_fields(const std::string& file) {
  std::size_t at = 0;
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::runtime_error("tensor file: " + what);
  };
  const auto take = [&](auto value) {
    require(at + sizeof value <= file.size(), "cut off");
    std::memcpy(&value, file.data() + at, sizeof value);
    at += sizeof value;
    return value;
  };
  require(file.substr(0, 12) == std::string("tensor_file\0", 12), "magic");
  at = 12;
  require(take(std::uint8_t{}) == 1, "major version");
  require(take(std::uint8_t{}) == 0, "minor version");
  std::map<std::string, TensorBytes> fields;
  std::size_t end = 0;
  const auto count = take(std::uint32_t{});
  for (std::uint32_t k = 0; k < count; ++k) {
    TensorBytes f;
    const auto length = take(std::uint16_t{});
    f.name = file.substr(at, length);
    at += length;
    const auto dimensions = take(std::uint16_t{});
    f.type = take(std::uint8_t{});
    require(f.type == 1 || f.type == 10, f.name + ": type");
    const auto offset = take(std::uint64_t{});
    std::uint64_t bytes = f.type == 1 ? 1 : 4;
    for (int d = 0; d < dimensions; ++d) {
      f.shape.push_back(take(std::uint64_t{}));
      bytes *= f.shape.back();
    }
    require(offset % 8 == 0 && (end == 0 || (offset >= end && offset < end + 8)),
            f.name + ": place");
    require(offset + bytes <= file.size(), f.name + ": beyond the end");
    end = offset + bytes;
    f.values = file.substr(offset, bytes);
    require(fields.emplace(f.name, f).second, f.name + ": twice");
  }
  require(end == file.size(), "bytes behind the last field");
  return fields;
}

inline std::vector<float> floats_of(const TensorBytes& field) {
  std::vector<float> values(field.values.size() / sizeof(float));
  std::memcpy(values.data(), field.values.data(), field.values.size());
  return values;
}

}  // namespace clothbrdf::test
