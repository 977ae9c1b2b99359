// Mutations of valid files, always the same ones: the readers must return or throw InputError, nothing else.
// tests/fuzz/readers_libfuzzer.cpp gives the same functions to libFuzzer.

#include "tests/fuzz/readers.hpp"
#include "tests/identification/valid_experiment.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace snare::identification {
namespace {

const std::vector<std::string> tokens{"nan",
                                      "inf",
                                      "-inf",
                                      "1e999",
                                      "-1",
                                      "0",
                                      "1e-320",
                                      "9223372036854775807",
                                      "0x7fffffffffffffff",
                                      "true",
                                      "\"",
                                      "'",
                                      "\"\"\"",
                                      "'''",
                                      "[",
                                      "]",
                                      "[[",
                                      "]]",
                                      "{",
                                      "}",
                                      "=",
                                      ".",
                                      ",",
                                      "#",
                                      "\n",
                                      "\r\n",
                                      "\r",
                                      "\t",
                                      std::string("\0", 1),
                                      "\xEF\xBB\xBF",
                                      "\xFF",
                                      "\xC3",
                                      "\xF0\x9F\x94\xA9",
                                      "\\",
                                      "\\u0000",
                                      "\\U0010FFFF",
                                      "1979-05-27T07:32:00Z",
                                      "[series]",
                                      "[[series]]",
                                      "name = \"s40\"",
                                      "wire.length_mm = 1",
                                      "series[s40].points",
                                      "--set series[s40].points=3\n",
                                      "a.b.c.d.e = 1",
                                      "file = \"/\"",
                                      "file = \".\"",
                                      "displacement_mm",
                                      "force_N",
                                      "time_s",
                                      "1,2,3\n",
                                      ",,,,,,,,",
                                      "path_mm = [0, 1e3, -1e3]"};

/// One to eight small changes at random places.
std::string mutated(const std::string& seed, const std::string& other, std::mt19937_64& random) {
  std::string text = seed;
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  const std::size_t changes = 1 + below(8);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(text.size() - at, 1 + below(40));
    switch (below(7)) {
      case 0:
        text.insert(at, 1, static_cast<char>(below(256)));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, tokens[below(tokens.size())]);
        break;
      case 3:
        text.replace(at, length, tokens[below(tokens.size())]);
        break;
      case 4:
        text.insert(at, text.substr(below(text.size() + 1), 1 + below(200)));
        break;
      case 5:
        text.insert(at, other.substr(below(other.size()), 1 + below(200)));
        break;
      default:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
    }
  }
  return text;
}

/// Runs `read` on `count` mutations; what it throws fails the test with the text that did it.
void expect_input_errors_only(const std::vector<std::string>& seeds,
                              const std::function<void(std::string_view)>& read, int count) {
  std::mt19937_64 random(20240229);
  for (int i = 0; i < count; ++i) {
    const auto pick = [&] {
      return seeds[std::uniform_int_distribution<std::size_t>(0, seeds.size() - 1)(random)];
    };
    const std::string text = mutated(pick(), pick(), random);
    ASSERT_NO_THROW(read(text)) << "mutation " << i << ":\n" << text;
  }
}

const std::vector<std::string> csv_seeds{"displacement_mm,force_N\n0,0\n0.1,0.5\n0.2,1.5\n",
                                         "\xEF\xBB\xBF# comment\r\ntime_s, displacement_mm ,force_N,\"note, "
                                         "more\"\r\n0,0,1e-3,\"a # b\"\r\n\r\n1,.5,-2.5E+1,c # d\r\n",
                                         "# \xC2\xB5m\nforce_N,displacement_mm\n+1,2.\n3,4"};

const std::vector<std::string> experiment_seeds{
    valid_experiment, "--set wire.length_mm=181\n" + valid_experiment,
    "--set series[s40].mount.span_mm=174\n" + valid_experiment,
    edited("travel_mm = 2.0",
           "path_mm = [0, 2.0, 0.0]\nmount.kind = 'supports'\nmount.support_radius_mm = 2"),
    edited("travel_mm = 2.0\npoints = 21", "file = 's40.csv'\nforce_sigma_N = 0.05")};

TEST(FuzzReaders, ValidSeedsAndAThousandMutations) {
  for (const std::string& seed : csv_seeds) EXPECT_TRUE(fuzz::read_bytes_as_csv(seed)) << seed;
  for (const std::string& seed : experiment_seeds) {
    const bool names_a_file = seed.find("s40.csv") != std::string::npos;  // which is not there
    EXPECT_EQ(fuzz::read_bytes_as_experiment(seed), !names_a_file) << seed;
  }
  expect_input_errors_only(csv_seeds, fuzz::read_bytes_as_csv, 1000);
  expect_input_errors_only(experiment_seeds, fuzz::read_bytes_as_experiment, 1000);
}

TEST(SlowFuzzReaders, CsvFiles) {
  expect_input_errors_only(csv_seeds, fuzz::read_bytes_as_csv, 500'000);
}

TEST(SlowFuzzReaders, ExperimentFiles) {
  expect_input_errors_only(experiment_seeds, fuzz::read_bytes_as_experiment, 50'000);
}

}  // namespace
}  // namespace snare::identification
