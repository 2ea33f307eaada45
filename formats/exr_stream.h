#pragma once

#include <ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <vector>

#include "support/atomic_file.h"
#include "support/errors.h"

namespace clothbrdf {

// Internal to formats/.

/// OpenEXR's own writer, into our file. It writes in small pieces, which are gathered here: call
/// finish() once it is done.
class AtomicOStream final : public Imf::OStream {
 public:
  explicit AtomicOStream(AtomicFile& file) : Imf::OStream(file.name().c_str()), file_(file) {
    buffer_.reserve(kBufferBytes);
  }
  void write(const char bytes[], int count) override {
    const auto piece = std::as_bytes(std::span(bytes, static_cast<std::size_t>(count)));
    if (buffer_.size() + piece.size() > kBufferBytes) flush();
    if (piece.size() > kBufferBytes) {
      put(piece);
    } else {
      buffer_.insert(buffer_.end(), piece.begin(), piece.end());
    }
  }
  std::uint64_t tellp() override { return start_ + buffer_.size(); }
  void seekp(std::uint64_t position) override {
    flush();
    start_ = position;
  }

  /// The last call. Throws WorkError, also that of an earlier write: OpenEXR's destructor keeps
  /// quiet about it.
  void finish() {
    if (failure_) std::rethrow_exception(failure_);
    flush();
  }

 private:
  void flush() {
    put(buffer_);
    buffer_.clear();
  }
  void put(std::span<const std::byte> bytes) {
    try {
      file_.write_at(start_, bytes);
    } catch (const WorkError&) {
      failure_ = std::current_exception();
      throw;
    }
    start_ += bytes.size();
  }

  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

  AtomicFile& file_;
  std::uint64_t start_ = 0;  // of the buffer, in the file
  std::exception_ptr failure_;
  std::vector<std::byte> buffer_;
};

}  // namespace clothbrdf
