#include "base/archive.hpp"

#include "base/toml_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace snare::base {

struct Inner {
  double value = 0.0;
  std::string name;
};
struct Outer {
  std::vector<Inner> list;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd matrix;
  long count = 0;
  bool flag = false;
};
template <class Archive>
void fields(Archive& a, Inner& i) {
  a(i.value)(i.name);
}
template <class Archive>
void fields(Archive& a, Outer& o) {
  a(o.list)(o.vector)(o.matrix)(o.count)(o.flag);
}

namespace {

Outer example() {
  Outer o;
  o.list = {{0.1, "first"}, {-std::numeric_limits<double>::infinity(), ""}};
  o.vector = {1.0, 1e-300, -0.0};
  o.matrix = Eigen::Matrix3Xd::Random(3, 4);
  o.count = -7;
  o.flag = true;
  return o;
}

std::string written(Outer o) {
  ByteWriter writer;
  writer(o);
  return writer.bytes();
}

TEST(Archive, ReadsBackTheSameBits) {
  const std::string bytes = written(example());
  Outer back;
  ByteReader reader(bytes);
  reader(back);
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(written(back), bytes);
  EXPECT_EQ(back.list[0].name, "first");
  EXPECT_EQ(back.list[1].value, -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::signbit(back.vector[2]));
  EXPECT_EQ(back.matrix.cols(), 4);
  EXPECT_EQ(back.count, -7);
}

// However short the bytes are and whatever stands in them: an exception, not a crash or a huge allocation.
TEST(Archive, RefusesWhatItCannotBe) {
  const std::string bytes = written(example());
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    Outer back;
    ByteReader reader(std::string_view(bytes).substr(0, n));
    EXPECT_THROW(reader(back), std::runtime_error) << n;
  }
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    std::string wrong = bytes;
    wrong[n] = static_cast<char>(0xff);
    Outer back;
    ByteReader reader(wrong);
    try {
      reader(back);
    } catch (const std::runtime_error&) {
    }
  }
}

TEST(Fingerprint, IsThatOfTheLiterature) {
  // Test vectors of FNV-1a, 64 bits.
  EXPECT_EQ(fingerprint(""), 0xcbf29ce484222325u);
  EXPECT_EQ(fingerprint("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(fingerprint("foobar"), 0x85944171f73967e8u);
}

TEST(CanonicalText, SeesValuesNotTheirForm) {
  const auto text = [](const char* toml) { return canonical_text(parse_toml("x", toml)); };
  EXPECT_EQ(text("a = 1\nb = 0.5 # comment\n[c]\nd = \"x\"\n"), text("b = 5e-1\na = 1.0\nc.d = 'x'\n"));
  EXPECT_NE(text("a = 1.0"), text("a = 1.0000000000000002"));
  EXPECT_NE(text("a = [1, 2]"), text("a = [2, 1]"));
  EXPECT_NE(text("a = \"1\""), text("a = 1"));
}

}  // namespace
}  // namespace snare::base
