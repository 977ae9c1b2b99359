#include "identification/tracing/outside_causes.hpp"

#include "identification/effects/catalogue.hpp"

#include <algorithm>

namespace snare::identification {

namespace {

constexpr double indistinct_chi2 = 6.0;  // difference below which the likelihood does not decide
constexpr double as_well = 0.05;         // by which less of the excess may carry over
constexpr double one_cause = 0.9;        // share carried over beside which several effects are not believed
// P below which an effect has left something in the direction of its rival
constexpr double rest_of_rival = 0.001;

/// Whether the function has this effect in it: it is of its channel, or one of its numbers where it has no
/// slope.
bool contains(const ChannelFunction& f, const Effect& effect) {
  const auto is_constant = [&f](const EffectNumber& n) { return n.parameter.key == f.constant; };
  return f.channel == effect.channel ||
         std::any_of(effect.numbers.begin(), effect.numbers.end(), is_constant);
}

}  // namespace

std::vector<ChannelFunction> rivals_outside(const std::vector<ChannelFunction>& functions,
                                            const std::vector<std::string>& names, double explained,
                                            double predicted) {
  std::vector<ChannelFunction> rivals;
  for (const ChannelFunction& f : functions) {
    const bool known = std::any_of(names.begin(), names.end(),
                                   [&f](const std::string& n) { return contains(f, *find_effect(n)); });
    const bool as_good =
        f.chi2 < explained + indistinct_chi2 && f.carried_over > std::min(predicted, 1.0) - as_well;
    if (!known && f.accepted && as_good) rivals.push_back(f);
  }
  return rivals;
}

bool one_for_several(const std::vector<ChannelFunction>& rivals) {
  return std::any_of(rivals.begin(), rivals.end(),
                     [](const ChannelFunction& f) { return f.carried_over > one_cause; });
}

bool simpler_outside(const std::vector<ChannelFunction>& rivals, const Model& model, const Data& data,
                     const Fit& current, std::size_t effects) {
  bool simpler = effects > 1 && one_for_several(rivals);
  for (const ChannelColumns& c : channel_columns(model, data, current)) {
    const bool rival = std::any_of(rivals.begin(), rivals.end(), [&c](const ChannelFunction& f) {
      return f.channel == c.channel && f.argument == c.argument;
    });
    simpler = simpler || (rival && channel_p(c, current) < rest_of_rival);
  }
  return simpler;
}

}  // namespace snare::identification
