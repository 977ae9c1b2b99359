#pragma once

#include <gtest/gtest.h>

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace snare::test {

/// An empty folder, which goes away with the test.
class FolderFixture : public testing::Test {
 public:
  ~FolderFixture() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  FolderFixture(const FolderFixture&) = delete;
  FolderFixture& operator=(const FolderFixture&) = delete;

 protected:
  FolderFixture() {
    std::string pattern = (std::filesystem::temp_directory_path() / "snare_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  /// Writes a file of the folder; its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  [[nodiscard]] std::string contents(const std::filesystem::path& file) const {
    std::ifstream stream(folder_ / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  std::filesystem::path folder_;
};

}  // namespace snare::test
