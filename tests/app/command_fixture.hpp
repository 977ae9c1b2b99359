#pragma once

#include "tests/support/folder_fixture.hpp"

#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace snare::app {

/// The command in an empty folder, which goes away with the test.
class CommandFixture : public test::FolderFixture {
 protected:
  /// Exit status of a line of the shell in the folder; -1 when a signal ended it.
  [[nodiscard]] int shell(const std::string& line) const {
    const int status = std::system(("cd '" + folder_.string() + "' && " + line).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// Exit status of `snare ARGUMENTS`; what it says goes to out.txt and err.txt.
  [[nodiscard]] int run(const std::string& arguments) const {
    return shell("'" SNARE_COMMAND "' " + arguments + " >out.txt 2>err.txt");
  }
  [[nodiscard]] nlohmann::json parsed(const std::filesystem::path& file) const {
    return nlohmann::json::parse(contents(file));
  }
};

}  // namespace snare::app
