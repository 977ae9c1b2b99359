#pragma once

#include "scenario/composition.hpp"

namespace snare::scenario {

/// `[[snares]]`: a fixed and a turning ring with wires between, on a carriage or not, within a housing's wall
/// or not. Adds them to the composition, to be placed with all else; their wires and walls follow.
///                                                                                           theory.md (M.24)
class Snares {
 public:
  explicit Snares(Composition& composition);
  ~Snares();
  Snares(const Snares&) = delete;
  Snares& operator=(const Snares&) = delete;
  /// Behind the resolved placement, before the shapes: they may name the wires.
  void add_wires();
  /// Behind all wires.
  void add_walls();

 private:
  struct Item;
  void place(const Item& item, const PlacedFrame& on);

  Composition& c_;
  std::vector<Item> items_;
};

}  // namespace snare::scenario
