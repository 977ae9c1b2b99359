#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace snare::app {

/// The command in an empty folder, which goes away with the test.
class CommandFixture : public testing::Test {
 protected:
  CommandFixture() {
    std::string pattern = (std::filesystem::temp_directory_path() / "snare_command_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~CommandFixture() override { std::filesystem::remove_all(folder_); }
  CommandFixture(const CommandFixture&) = delete;
  CommandFixture& operator=(const CommandFixture&) = delete;

  /// Exit status of a line of the shell in the folder; -1 when a signal ended it.
  [[nodiscard]] int shell(const std::string& line) const {
    const int status = std::system(("cd '" + folder_.string() + "' && " + line).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// Exit status of `snare ARGUMENTS`; what it says goes to out.txt and err.txt.
  [[nodiscard]] int run(const std::string& arguments) const {
    return shell("'" SNARE_COMMAND "' " + arguments + " >out.txt 2>err.txt");
  }
  /// Of a file in the folder.
  [[nodiscard]] std::string contents(const std::filesystem::path& file) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / file, std::ios::binary).rdbuf();
    return text.str();
  }
  [[nodiscard]] nlohmann::json parsed(const std::filesystem::path& file) const {
    return nlohmann::json::parse(contents(file));
  }

  std::filesystem::path folder_;
};

}  // namespace snare::app
