#pragma once

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace snare::referee {

/// Random numbers of one problem. The same seed and index give the same problem, whatever was drawn before.
class Draws {
 public:
  Draws(unsigned seed, int index) {
    std::seed_seq sequence{seed, static_cast<unsigned>(index)};
    random_.seed(sequence);
  }
  [[nodiscard]] double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// Even in the logarithm; low > 0.
  [[nodiscard]] double of_any_size(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  [[nodiscard]] bool chance(double share) { return between(0.0, 1.0) < share; }
  [[nodiscard]] int count(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  template <class T>
  [[nodiscard]] T one_of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(count(0, static_cast<int>(list.size()) - 1))];
  }
  [[nodiscard]] std::mt19937& generator() { return random_; }

 private:
  std::mt19937 random_;
};

/// Which problems a referee draws: a fixed seed and a fixed number of them, unless the environment names
/// others.
///   SNARE_REFEREE_SEED, SNARE_REFEREE_COUNT: seed and number of problems
///   SNARE_REFEREE_ONLY: index of the only problem to run
struct Problems {
  unsigned seed;
  int first, end;

  explicit Problems(int count) : seed(static_cast<unsigned>(number("SNARE_REFEREE_SEED", 1))), first(0) {
    end = number("SNARE_REFEREE_COUNT", count);
    const int only = number("SNARE_REFEREE_ONLY", -1);
    if (only < 0) return;
    first = only;
    end = only + 1;
  }

 private:
  static int number(const char* name, int otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::stoi(text);
  }
};

}  // namespace snare::referee
