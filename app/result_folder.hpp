#pragma once

#include "app/console.hpp"
#include "base/result_folder.hpp"

#include <string>
#include <vector>

namespace snare::app {

/// The folder of a verb's results, held until the verb ends. See base::ResultFolder.
class ResultFolder {
 public:
  ResultFolder(const CommonOptions& options, const std::vector<std::string>& files)
      : held_(options.out, files, {"--out", options.command}) {}

 private:
  base::ResultFolder held_;
};

}  // namespace snare::app
