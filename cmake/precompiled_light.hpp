// The same for modules that read and write (LIGHT in cmake/SnareModule.cmake), with JSON.
#pragma once

#include "precompiled.hpp"

#include <fmt/ranges.h>
#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include <fstream>
#include <mutex>
#include <set>
#include <sstream>
#include <variant>
