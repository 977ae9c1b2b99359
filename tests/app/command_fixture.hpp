#pragma once

#include "tests/support/folder_fixture.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

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
  /// Starts `snare ARGUMENTS` in the folder; what it says goes to out.txt and err.txt, anew.
  [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all{SNARE_COMMAND};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(all.size() + 1);
    for (std::string& a : all) argv.push_back(a.data());
    argv.push_back(nullptr);
    const std::string folder = folder_.string();
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (::chdir(folder.c_str()) != 0) ::_exit(126);
    ::dup2(::open("out.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600), 1);
    ::dup2(::open("err.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600), 2);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  /// How a process ended, and how long after it was told to.
  struct Ending {
    int status;      ///< minus the signal that ended it
    double seconds;  ///< from the signal
  };
  /// Whether a process catches a signal: where the machine is busy, its start takes a while.
  [[nodiscard]] static bool catches(pid_t child, int signal) {
    std::ifstream status("/proc/" + std::to_string(child) + "/status");
    const std::string key = "SigCgt:";
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with(key))
        return (std::stoull(line.substr(key.size()), nullptr, 16) >> (signal - 1) & 1U) != 0;
    }
    return false;
  }
  /// Sends a signal a time [s] after it is caught, and waits. SIGKILL, which nobody catches, goes a time
  /// after the call.
  [[nodiscard]] static Ending interrupt(pid_t child, double after, int signal = SIGINT) {
    constexpr int most_looks = 2000;
    for (int k = 0; k < most_looks && signal != SIGKILL && !catches(child, signal); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::duration<double>(after));
    ::kill(child, signal);
    const auto begin = std::chrono::steady_clock::now();
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
  }
  [[nodiscard]] nlohmann::json parsed(const std::filesystem::path& file) const {
    return nlohmann::json::parse(contents(file));
  }
};

}  // namespace snare::app
