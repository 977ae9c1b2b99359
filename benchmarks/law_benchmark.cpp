// The force of a law.json at points of a file, for benchmarks/python_overhead.py: travel, then position, then
// slack of all points as doubles [m]. Prints the time of the loop and the sum of the forces.
#include "scenario/distilled_law.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <fstream>
#include <numeric>
#include <vector>

int main(int count, char** arguments) try {
  if (count != 3) {
    fmt::print(stderr, "usage: law_benchmark LAW.json POINTS\n");
    return 2;
  }
  const snare::scenario::DistilledLaw law = snare::scenario::read_law_file(arguments[1]).front();
  std::ifstream file(arguments[2], std::ios::binary | std::ios::ate);
  std::vector<double> numbers(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  const std::size_t points = numbers.size() / 3;
  const double* const d = numbers.data();
  std::vector<double> force(points);
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < points; ++i)
    force[i] = snare::scenario::DistilledLaw::force(*law.loading, d[i], d[points + i], d[2 * points + i],
                                                    snare::coupling::Outside::refuse)
                   .force;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  fmt::print("{{\"seconds\": {}, \"sum_N\": {}}}\n", seconds,
             std::accumulate(force.begin(), force.end(), 0.0));
} catch (const std::exception& problem) {
  fmt::print(stderr, "{}\n", problem.what());
  return 1;
}
