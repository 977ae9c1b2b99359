#include "coupling/contact/mesh_file.hpp"

#include "base/errors.hpp"
#include "base/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>

namespace snare::coupling {

using Eigen::Vector3d;

namespace {

constexpr std::size_t size_limit = 512u << 20u;      // [byte]
constexpr std::size_t stl_header = 80;               // [byte]
constexpr std::size_t stl_triangle = 50;             // [byte]: normal, three corners, an attribute
constexpr std::size_t most_triangles = 100'000'000;  // what an int can number, with room

/// Words of a text, line after line.
class Words {
 public:
  Words(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {}

  /// The words of the next line that has any; '#' begins a comment. False at the end.
  bool next_line() {
    words_.clear();
    while (words_.empty() && at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      split(text_.substr(at_, end - at_));
      at_ = end + 1;
      ++line_;
    }
    return !words_.empty();
  }
  [[nodiscard]] std::size_t count() const { return words_.size(); }
  [[nodiscard]] std::string_view word(std::size_t k) const {
    return k < words_.size() ? words_[k] : std::string_view();
  }
  /// Words are case-blind in ascii STL.
  [[nodiscard]] bool is(std::size_t k, std::string_view lower) const {
    const std::string_view w = word(k);
    return std::equal(w.begin(), w.end(), lower.begin(), lower.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
  }
  [[nodiscard]] double number(std::size_t k) const {
    const std::string_view w = word(k);
    double value = 0.0;
    const std::string_view digits = w.starts_with('+') ? w.substr(1) : w;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || error != std::errc() || end != digits.data() + digits.size() ||
        !std::isfinite(value))
      fail(w, "must be a finite number");
    return value;
  }
  [[nodiscard]] Vector3d point(std::size_t first) const {
    return {number(first), number(first + 1), number(first + 2)};
  }
  [[nodiscard]] long integer(std::string_view w, const std::string& requirement) const {
    long value = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (w.empty() || error != std::errc() || end != w.data() + w.size()) fail(w, requirement);
    return value;
  }
  [[noreturn]] void fail(std::string_view value, const std::string& requirement) const {
    throw base::InputError({file_, line_, "mesh", std::string(value), requirement});
  }

 private:
  void split(std::string_view line) {
    line = line.substr(0, line.find('#'));
    std::size_t k = 0;
    while (k < line.size()) {
      while (k < line.size() && std::isspace(static_cast<unsigned char>(line[k])) != 0) ++k;
      const std::size_t begin = k;
      while (k < line.size() && std::isspace(static_cast<unsigned char>(line[k])) == 0) ++k;
      if (k > begin) words_.push_back(line.substr(begin, k - begin));
    }
  }

  std::string file_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::vector<std::string_view> words_;
};

/// Points that agree to the last bit get one number.
class Weld {
 public:
  explicit Weld(TriangleMesh& mesh) : mesh_(mesh) {}
  int operator()(const Vector3d& p) {
    const auto [place, added] =
        index_.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, static_cast<int>(mesh_.points.size()));
    if (added) mesh_.points.push_back(p);
    return place->second;
  }

 private:
  TriangleMesh& mesh_;
  std::map<std::array<double, 3>, int> index_;
};

void read_ascii_stl(Words& words, TriangleMesh& mesh) {
  Weld weld(mesh);
  words.next_line();  // solid NAME
  bool ended = false;
  while (!ended) {
    if (!words.next_line()) words.fail("", "ends before \"endsolid\"");
    if (words.is(0, "endsolid")) {
      // A file may hold several solids.
      ended = !words.next_line();
      if (!ended && !words.is(0, "solid"))
        words.fail(words.word(0), "must be \"solid\" or the end of the file");
      continue;
    }
    if (!words.is(0, "facet")) words.fail(words.word(0), "must be \"facet\" or \"endsolid\"");
    if (!words.next_line() || !words.is(0, "outer")) words.fail(words.word(0), "must be \"outer loop\"");
    std::array<int, 3> triangle{};
    for (int& corner : triangle) {
      if (!words.next_line() || !words.is(0, "vertex"))
        words.fail(words.word(0), "must be \"vertex\" with three numbers");
      corner = weld(words.point(1));
    }
    if (!words.next_line() || !words.is(0, "endloop"))
      words.fail(words.word(0), "must be \"endloop\": facets are triangles");
    if (!words.next_line() || !words.is(0, "endfacet")) words.fail(words.word(0), "must be \"endfacet\"");
    mesh.triangles.push_back(triangle);
  }
}

template <class Value>
Value little_endian(const char* from) {
  static_assert(std::endian::native == std::endian::little);
  Value value{};
  std::memcpy(&value, from, sizeof value);
  return value;
}

void read_binary_stl(std::string_view data, TriangleMesh& mesh) {
  Weld weld(mesh);
  const auto count = little_endian<std::uint32_t>(data.data() + stl_header);
  for (std::uint32_t k = 0; k < count; ++k) {
    const char* at = data.data() + stl_header + sizeof(std::uint32_t) + k * stl_triangle + 3 * sizeof(float);
    std::array<int, 3> triangle{};
    for (int& corner : triangle) {
      Vector3d p;
      for (double& x : p) {
        x = static_cast<double>(little_endian<float>(at));
        at += sizeof(float);
        if (!std::isfinite(x)) {
          throw base::InputError({mesh.name, 0, fmt::format("mesh triangle {}", k), fmt::format("{}", x),
                                  "must be a finite number"});
        }
      }
      corner = weld(p);
    }
    mesh.triangles.push_back(triangle);
  }
}

/// Fan of a polygon.
void add_polygon(const std::vector<int>& corners, TriangleMesh& mesh) {
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    mesh.triangles.push_back({corners[0], corners[k], corners[k + 1]});
}

void read_obj(Words& words, TriangleMesh& mesh) {
  std::vector<int> corners;
  while (words.next_line()) {
    if (words.word(0) == "v") {
      mesh.points.push_back(words.point(1));
    } else if (words.word(0) == "f") {
      corners.clear();
      const auto points = static_cast<long>(mesh.points.size());
      const std::string requirement =
          fmt::format("must be a point's number, 1 to {} (or -1 to -{} from the last)", points, points);
      if (words.count() < 4) words.fail(words.word(0), "must have three corners or more");
      for (std::size_t k = 1; k < words.count(); ++k) {
        const std::string_view w = words.word(k);
        const long given = words.integer(w.substr(0, w.find('/')), requirement);
        const long index = given > 0 ? given - 1 : points + given;
        if (given == 0 || index < 0 || index >= points) words.fail(w, requirement);
        corners.push_back(static_cast<int>(index));
      }
      add_polygon(corners, mesh);
    }
    // Lines of other kinds (normals, textures, groups, materials) say nothing about the shape.
  }
}

void read_off(Words& words, TriangleMesh& mesh) {
  if (!words.next_line() || words.word(0) != "OFF")
    words.fail(words.word(0), "must be \"OFF\" in the first line");
  std::size_t first = 1;
  if (words.count() == 1) {
    if (!words.next_line()) words.fail("", "must have the numbers of points and faces");
    first = 0;
  }
  const std::string counts = "must be the number of points, then that of faces, 0 or more";
  const long points = words.integer(words.word(first), counts);
  const long faces = words.integer(words.word(first + 1), counts);
  if (points < 0 || faces < 0) words.fail(words.word(first), counts);
  for (long k = 0; k < points; ++k) {
    if (!words.next_line()) words.fail("", fmt::format("ends after {} of {} points", k, points));
    mesh.points.push_back(words.point(0));
  }
  std::vector<int> corners;
  for (long k = 0; k < faces; ++k) {
    if (!words.next_line()) words.fail("", fmt::format("ends after {} of {} faces", k, faces));
    const long count = words.integer(words.word(0), "must be the number of the face's corners");
    if (count < 3 || static_cast<std::size_t>(count) + 1 > words.count())
      words.fail(words.word(0), "must be the number of the face's corners, 3 or more, which follow");
    corners.clear();
    for (long c = 1; c <= count; ++c) {
      const std::string requirement = fmt::format("must be a point's index, 0 to {}", points - 1);
      const long index = words.integer(words.word(static_cast<std::size_t>(c)), requirement);
      if (index < 0 || index >= points) words.fail(words.word(static_cast<std::size_t>(c)), requirement);
      corners.push_back(static_cast<int>(index));
    }
    add_polygon(corners, mesh);
  }
}

}  // namespace

TriangleMesh read_triangle_mesh(const std::filesystem::path& file, double unit) {
  TriangleMesh mesh;
  mesh.name = file.string();
  const auto refuse = [&mesh](const std::string& value, const std::string& requirement) {
    throw base::InputError({mesh.name, 0, "mesh", value, requirement});
  };
  if (!std::isfinite(unit) || unit <= 0.0) refuse(fmt::format("unit {}", unit), "must be a length > 0 m");
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".stl" && extension != ".obj" && extension != ".off")
    refuse(extension, "must be a file with the ending .stl, .obj or .off");
  const std::string data = base::read_text(file, size_limit);
  Words words(mesh.name, data);
  if (extension == ".obj") {
    read_obj(words, mesh);
  } else if (extension == ".off") {
    read_off(words, mesh);
  } else {
    // The length tells a binary STL, whose header may begin with "solid" too.
    const std::size_t fixed = stl_header + sizeof(std::uint32_t);
    const std::size_t count =
        data.size() >= fixed ? little_endian<std::uint32_t>(data.data() + stl_header) : 0;
    const bool ascii = data.substr(0, 5) == "solid";
    if (data.size() >= fixed && data.size() == fixed + count * stl_triangle)
      read_binary_stl(data, mesh);
    else if (ascii)
      read_ascii_stl(words, mesh);
    else
      refuse(fmt::format("{} bytes", data.size()),
             data.size() < fixed
                 ? "is no STL: neither \"solid\" nor a binary header"
                 : fmt::format("is no STL: neither \"solid\" nor the {} bytes of {} binary triangles",
                               fixed + count * stl_triangle, count));
  }
  if (mesh.triangles.empty()) refuse("0 triangles", "must have some");
  if (mesh.triangles.size() > most_triangles)
    refuse(fmt::format("{} triangles", mesh.triangles.size()),
           fmt::format("must have at most {}", most_triangles));
  for (Vector3d& p : mesh.points) p *= unit;
  return mesh;
}

}  // namespace snare::coupling
