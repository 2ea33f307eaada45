#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <span>

#include "support/atomic_file.h"

namespace clothbrdf {

// Internal to formats/.

/// OpenEXR's own writer, into our file.
class AtomicOStream final : public Imf::OStream {
 public:
  explicit AtomicOStream(AtomicFile& file) : Imf::OStream(file.name().c_str()), file_(file) {}
  void write(const char bytes[], int count) override {
    file_.write_at(position_, std::as_bytes(std::span(bytes, static_cast<std::size_t>(count))));
    position_ += static_cast<std::uint64_t>(count);
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

 private:
  AtomicFile& file_;
  std::uint64_t position_ = 0;
};

}  // namespace clothbrdf
