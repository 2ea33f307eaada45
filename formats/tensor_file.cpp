#include "formats/tensor_file.h"

#include <half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>
#include <utility>

#include "formats/format.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::string_view kMagic("tensor_file\0", 12);
constexpr std::array<std::uint8_t, 2> kVersion = {1, 0};
constexpr std::uint64_t kAlignment = 8;
// Far beyond any use, and a header of so many would be megabytes.
constexpr std::uint32_t kMostFields = 1000;
constexpr std::uint16_t kMostDimensions = 16;

std::uint64_t size_of(TensorType type) {
  switch (type) {
    case TensorType::kUint8:
    case TensorType::kInt8: return 1;
    case TensorType::kUint16:
    case TensorType::kInt16:
    case TensorType::kFloat16: return 2;
    case TensorType::kUint32:
    case TensorType::kInt32:
    case TensorType::kFloat32: return 4;
    case TensorType::kUint64:
    case TensorType::kInt64:
    case TensorType::kFloat64: break;
  }
  return 8;
}

class HeaderWriter {
 public:
  void text(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  template <class T>
  void number(T value) {
    const auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

// Reads the head, and never beyond the end of the file.
class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& path, std::string name)
      : in_(path, std::ios::binary | std::ios::ate), name_(std::move(name)) {
    size_ = static_cast<std::uint64_t>(in_.tellg());
    in_.seekg(0);
  }
  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(name_ + ": " + what); }

  std::string text(std::size_t length) {
    if (length > size_ - position_) refuse("the file is cut off inside its header");
    std::string text(length, '\0');
    in_.read(text.data(), static_cast<std::streamsize>(length));
    if (!in_) refuse("cannot read the header");
    position_ += length;
    return text;
  }
  template <class T>
  T number() {
    T value{};
    std::memcpy(&value, text(sizeof value).data(), sizeof value);
    return value;
  }

 private:
  std::ifstream in_;
  std::string name_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

Tensor read_field(HeaderReader& in) {
  Tensor field;
  const auto length = in.number<std::uint16_t>();
  field.name = in.text(length);
  if (length == 0 || !std::all_of(field.name.begin(), field.name.end(),
                                  [](char c) { return c > ' ' && c <= '~'; })) {
    in.refuse("the name of a field is not a word of printable characters");
  }
  const auto dimensions = in.number<std::uint16_t>();
  const std::string where = "field '" + field.name + "'";
  if (dimensions > kMostDimensions) {
    in.refuse(where + " has " + std::to_string(dimensions) + " dimensions; at most " +
              std::to_string(kMostDimensions) + " are allowed");
  }
  const auto type = in.number<std::uint8_t>();
  if (type < static_cast<std::uint8_t>(TensorType::kUint8) ||
      type > static_cast<std::uint8_t>(TensorType::kFloat64)) {
    in.refuse(where + " has the type " + std::to_string(type) + "; 1 to 11 are known");
  }
  field.type = static_cast<TensorType>(type);
  field.offset = in.number<std::uint64_t>();
  // Multiplied so that no product leaves 64 bits.
  std::uint64_t bytes = size_of(field.type);
  for (int d = 0; d < dimensions; ++d) {
    const auto size = in.number<std::uint64_t>();
    field.shape.push_back(size);
    if (size != 0 && bytes > in.size() / size) {
      in.refuse(where + ": its shape " + shape_text(field.shape) + " is too large for the file");
    }
    bytes *= size;
  }
  if (bytes == 0) in.refuse(where + ": its shape " + shape_text(field.shape) + " holds nothing");
  if (field.offset > in.size() || bytes > in.size() - field.offset) {
    in.refuse(where + ": its values go beyond the end of the file");
  }
  return field;
}

// Values follow the head without overlap, and nothing lies in between but padding.
void check_places(const HeaderReader& in, std::span<const Tensor> fields) {
  std::vector<const Tensor*> order;
  for (const Tensor& field : fields) order.push_back(&field);
  std::sort(order.begin(), order.end(),
            [](const Tensor* a, const Tensor* b) { return a->offset < b->offset; });
  constexpr std::uint64_t kMostPadding = 4096;  // a page
  std::uint64_t end = in.position();
  for (const Tensor* field : order) {
    if (field->offset < end || field->offset - end > kMostPadding) {
      in.refuse("field '" + field->name + "': its values do not follow the others'");
    }
    end = field->offset + field->bytes();
  }
  if (in.size() - end > kMostPadding) in.refuse("bytes follow the last field's values");
}

template <class T>
void append_as_floats(std::string_view bytes, std::vector<float>& numbers) {
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(T)) {
    T value{};
    std::memcpy(static_cast<void*>(&value), bytes.data() + at, sizeof value);
    numbers.push_back(static_cast<float>(value));
  }
}

void append_as_floats(TensorType type, std::string_view bytes, std::vector<float>& numbers) {
  switch (type) {
    case TensorType::kUint8: return append_as_floats<std::uint8_t>(bytes, numbers);
    case TensorType::kInt8: return append_as_floats<std::int8_t>(bytes, numbers);
    case TensorType::kUint16: return append_as_floats<std::uint16_t>(bytes, numbers);
    case TensorType::kInt16: return append_as_floats<std::int16_t>(bytes, numbers);
    case TensorType::kUint32: return append_as_floats<std::uint32_t>(bytes, numbers);
    case TensorType::kInt32: return append_as_floats<std::int32_t>(bytes, numbers);
    case TensorType::kUint64: return append_as_floats<std::uint64_t>(bytes, numbers);
    case TensorType::kInt64: return append_as_floats<std::int64_t>(bytes, numbers);
    case TensorType::kFloat16: return append_as_floats<half>(bytes, numbers);
    case TensorType::kFloat32: return append_as_floats<float>(bytes, numbers);
    case TensorType::kFloat64: return append_as_floats<double>(bytes, numbers);
  }
}

}  // namespace

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text;
  for (const std::uint64_t size : shape) {
    text += (text.empty() ? "" : " x ") + std::to_string(size);
  }
  return text.empty() ? "of one number" : text;
}

std::uint64_t Tensor::count() const {
  std::uint64_t count = 1;
  for (const std::uint64_t size : shape) count *= size;
  return count;
}

std::uint64_t Tensor::bytes() const { return count() * size_of(type); }

TensorHeader tensor_header(std::vector<Tensor> fields) {
  std::uint64_t end = kMagic.size() + kVersion.size() + sizeof(std::uint32_t);
  for (const Tensor& field : fields) {
    end += 2 * sizeof(std::uint16_t) + field.name.size() + sizeof(std::uint8_t) +
           (1 + field.shape.size()) * sizeof(std::uint64_t);
  }
  for (Tensor& field : fields) {
    field.offset = (end + kAlignment - 1) / kAlignment * kAlignment;
    end = field.offset + field.bytes();
  }
  HeaderWriter out;
  out.text(kMagic);
  for (const std::uint8_t part : kVersion) out.number(part);
  out.number(static_cast<std::uint32_t>(fields.size()));
  for (const Tensor& field : fields) {
    out.number(static_cast<std::uint16_t>(field.name.size()));
    out.text(field.name);
    out.number(static_cast<std::uint16_t>(field.shape.size()));
    out.number(static_cast<std::uint8_t>(field.type));
    out.number(field.offset);
    for (const std::uint64_t size : field.shape) out.number(size);
  }
  return {out.take(), std::move(fields), end};
}

TensorFile::TensorFile(const std::filesystem::path& path) : name_(path.string()), path_(path) {
  require_readable(path);
  HeaderReader in(path, name_);
  if (in.size() < kMagic.size() || in.text(kMagic.size()) != kMagic) {
    in.refuse("does not start with 'tensor_file': no RGL tensor file");
  }
  const auto major = in.number<std::uint8_t>();
  const auto minor = in.number<std::uint8_t>();
  if (major != kVersion[0] || minor != kVersion[1]) {
    in.refuse("version " + std::to_string(major) + "." + std::to_string(minor) +
              " is not known; 1.0 is");
  }
  const auto count = in.number<std::uint32_t>();
  if (count > kMostFields) {
    in.refuse(std::to_string(count) + " fields; at most " + std::to_string(kMostFields) +
              " are allowed");
  }
  for (std::uint32_t f = 0; f < count; ++f) {
    Tensor field = read_field(in);
    if (find(field.name) != nullptr) in.refuse("field '" + field.name + "' is there twice");
    fields_.push_back(std::move(field));
  }
  check_places(in, fields_);
}

const Tensor* TensorFile::find(const std::string& field) const {
  const auto found = std::find_if(fields_.begin(), fields_.end(),
                                  [&](const Tensor& tensor) { return tensor.name == field; });
  return found == fields_.end() ? nullptr : &*found;
}

const Tensor& TensorFile::field(const std::string& field) const {
  if (const Tensor* found = find(field)) return *found;
  throw InputError(name_ + ": field '" + field + "' is missing");
}

std::string TensorFile::bytes(const Tensor& field) const {
  std::ifstream in(path_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(field.offset));
  std::string bytes(field.bytes(), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw InputError(name_ + ": cannot read field '" + field.name + "'");
  return bytes;
}

std::vector<float> TensorFile::numbers(const Tensor& field) const {
  std::vector<float> numbers;
  numbers.reserve(field.count());
  append_as_floats(field.type, bytes(field), numbers);
  return numbers;
}

void TensorFile::refuse_shape(const Tensor& field, const std::string& allowed) const {
  throw InputError(name_ + ": field '" + field.name + "': its shape " + shape_text(field.shape) +
                   " is not allowed; " + allowed);
}

}  // namespace clothbrdf
