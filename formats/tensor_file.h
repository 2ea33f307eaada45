#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace clothbrdf {

/// What the numbers of a tensor are; the values are those of the file.
enum class TensorType : std::uint8_t {
  kUint8 = 1,
  kInt8 = 2,
  kUint16 = 3,
  kInt16 = 4,
  kUint32 = 5,
  kInt32 = 6,
  kUint64 = 7,
  kInt64 = 8,
  kFloat16 = 9,
  kFloat32 = 10,
  kFloat64 = 11,
};

/// One field of a tensor file, the last dimension contiguous.
struct Tensor {
  std::string name;
  TensorType type = TensorType::kFloat32;
  std::vector<std::uint64_t> shape = {};
  std::uint64_t offset = 0;  ///< of the values in the file

  std::uint64_t count() const;
  std::uint64_t bytes() const;
};

/// The head of a tensor file (version 1.0): "tensor_file\0", and the name, shape, type and place of
/// each field. The values follow in that order, each field at a multiple of 8 bytes.
struct TensorHeader {
  std::vector<std::byte> bytes;
  std::vector<Tensor> fields;   ///< with their offsets
  std::uint64_t file_size = 0;  ///< once all values are there
};

/// Places the fields. Their names are at most 65,535 bytes long.
TensorHeader tensor_header(std::vector<Tensor> fields);

/// A tensor file that was opened for reading. Its head is sound: names are unique and all values
/// inside the file, none of them shared by two fields, with nothing but padding between and behind.
class TensorFile {
 public:
  /// Throws InputError, in one line that starts with the file's name.
  explicit TensorFile(const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  std::span<const Tensor> fields() const { return fields_; }

  /// Null where there is no such field.
  const Tensor* find(const std::string& field) const;
  /// The same; throws InputError.
  const Tensor& field(const std::string& field) const;

  /// Values in the order of the file, whatever their type, rounded to floats.
  std::vector<float> numbers(const Tensor& field) const;
  /// The bytes of the values as they are.
  std::string bytes(const Tensor& field) const;

  /// "NAME: field 'x' has the shape 1 x 8; ...": ends the reading.
  [[noreturn]] void refuse_shape(const Tensor& field, const std::string& allowed) const;

 private:
  std::string name_;
  std::filesystem::path path_;
  std::vector<Tensor> fields_;
};

/// "3 x 28 x 28".
std::string shape_text(const std::vector<std::uint64_t>& shape);

}  // namespace clothbrdf
