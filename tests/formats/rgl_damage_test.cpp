#include <cmath>
#include <iostream>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/formats/small_rgl.h"

namespace clothbrdf::test {
namespace {}  // namespace

TEST_CASE("every truncation of an RGL file is refused") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  const std::string bytes = tensor_file(small_fields(random, 3, 2 * kPi));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    INFO(length << " of " << bytes.size() << " bytes");
    CHECK_THROWS_AS(read_bytes(folder, bytes.substr(0, length)), InputError);
  }
  CHECK_THROWS_WITH(read_bytes(folder, bytes.substr(0, bytes.size() - 1)),
                    ContainsSubstring("field 'jacobian': its values go beyond the end"));
  CHECK_NOTHROW(read_bytes(folder, bytes));
  CHECK_THROWS_WITH(read_bytes(folder, bytes + std::string(5000, 'x')),
                    ContainsSubstring("bytes follow"));
}

TEST_CASE("a changed byte in the head of an RGL file is refused or changes no shape") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  const Fields fields = small_fields(random, 3, 2 * kPi);
  const std::string bytes = tensor_file(fields);
  const Table whole = read_bytes(folder, bytes);
  int refused = 0;
  int read = 0;
  for (std::size_t at = 0; at < header_size(fields); ++at) {
    for (const int value : {0, 1, 7, 10, 0x7f, 0x80, 0xff, bytes[at] + 1, bytes[at] ^ 0x40}) {
      std::string changed = bytes;
      changed[at] = static_cast<char>(value);
      if (changed == bytes) continue;
      INFO("byte " << at << " is " << value);
      try {
        const Table table = read_bytes(folder, changed);
        CHECK(table.spec().cell_count() == whole.spec().cell_count());
        CHECK(table.spec().channels == whole.spec().channels);
        ++read;
      } catch (const InputError& error) {
        const std::string text = error.what();
        CHECK(text.rfind((folder / "t.bsdf").string() + ": ", 0) == 0);
        CHECK(text.find('\n') == std::string::npos);
        ++refused;
      }
    }
  }
  std::cout << "changed heads of RGL files: " << refused << " refused, " << read << " read\n";
  CHECK(refused > 1000);
  // Names of fields that may be missing, and the text's length.
  CHECK(read < 200);
}

TEST_CASE("an RGL file that contradicts itself is refused in one line") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  const Fields good = small_fields(random, 4, 2 * kPi);
  const auto refused = [&](const std::string& name, const TensorBytes& field,
                           const std::string& part) {
    Fields fields = good;
    field_of(fields, name) = field;
    CHECK_THROWS_WITH(read_bytes(folder, tensor_file(fields)), ContainsSubstring("t.bsdf: ") &&
                                                                   ContainsSubstring(part) &&
                                                                   !ContainsSubstring("\n"));
  };
  const auto floats = [](const std::string& name, Shape shape, const std::vector<float>& values) {
    return tensor_of(name, 10, std::move(shape), values);
  };
  const float nan = std::nanf("");
  refused("theta_i", floats("theta_i", {2}, {0.5F, 0.5F}), "ascending");
  refused("theta_i", floats("theta_i", {2}, {0, 2}), "'theta_i': node 1 is 2");
  refused("theta_i", floats("theta_i", {2}, {0, nan}), "'theta_i'");
  refused("theta_i", floats("theta_i", {1, 2}, {0, 1}), "one dimension");
  refused("theta_i", floats("theta_i", {3}, {0, 1, 1.5F}), "'vndf': its shape 4 x 2 x 2 x 3");
  refused("ndf", floats("ndf", {1, 6}, std::vector<float>(6, 1)), "'ndf': its shape 1 x 6");
  refused("ndf", floats("ndf", {2, 2}, {1, 1, -1, 1}), "'ndf' holds -1");
  refused("vndf", floats("vndf", {4, 2, 2, 2}, std::vector<float>(32, nan)), "'vndf' holds nan");
  refused("rgb", floats("rgb", {4, 2, 4, 2, 2}, std::vector<float>(128, 1)), "3 channels");
  refused("luminance", floats("luminance", {4, 2, 2, 3}, std::vector<float>(48, 1)), "N x N");
  refused("luminance", floats("light", {4, 2, 2, 2}, std::vector<float>(32, 1)),
          "'luminance' is missing");
  refused("sigma", floats("ndf", {2, 2}, {1, 1, 1, 1}), "'ndf' is there twice");
  refused("jacobian", tensor_of("jacobian", 12, {1}, std::vector<char>{1}), "type 12");
  refused("description", tensor_of("description", 1, {0}, std::vector<char>{}), "holds nothing");
  // The second field's values where the first one's are: 18 bytes of file head, 13 and the name and
  // 8 for one dimension of each field.
  std::string shared = tensor_file(good);
  const std::size_t first = 18 + 2 + 11 + 2 + 1;
  const std::size_t second = 18 + 13 + 11 + 8 + 2 + 5 + 2 + 1;
  shared.replace(second, 8, shared.substr(first, 8));
  CHECK_THROWS_WITH(read_bytes(folder, shared),
                    ContainsSubstring("its values do not follow the others'"));
  CHECK_THROWS_WITH(read_bytes(folder, "tensor_file"), ContainsSubstring("no RGL tensor file"));
  CHECK_THROWS_AS(format_for("t.bsdf").read(folder / "absent.bsdf"), InputError);
  CHECK_THROWS_AS(format_for("t.bsdf").read(folder.path()), InputError);
}

}  // namespace clothbrdf::test
