#pragma once

#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace snare::numerics {

/// A vector that somebody else stores.
using VectorView = Eigen::Ref<const Eigen::VectorXd>;

/// Whether the rate of an unknown appears in F(t, y, y') = 0.
enum class DaeKind { differential, algebraic };

/// Absolute tolerance of a stabilising multiplier, in any unit: none. Its round-off grows as one over the
/// step, and what it does to other unknowns is tested there.
constexpr double no_tolerance = 1e6;

/// Unknowns that belong together, for tolerances and for messages.
struct DaeBlock {
  std::string name;                     ///< "wire a position [m]"
  std::vector<std::string> components;  ///< names that repeat along the block, e.g. x, y, z; empty: none
  int count = 0;                        ///< of unknowns
  DaeKind kind = DaeKind::differential;
  double absolute_tolerance = 1e-8;  ///< of one unknown, in its unit, > 0
  int first = 0;                     ///< set by DaeLayout
  /// Whether the relative tolerance acts on them: not on places and angles, whose origin says nothing.
  bool relative = true;
};

/// The unknowns of all parts, one block behind another.
class DaeLayout {
 public:
  /// Appends a block; returns the index of its first unknown.
  int add(DaeBlock block);
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] const std::vector<DaeBlock>& blocks() const noexcept { return blocks_; }
  /// "wire a position [m], no. 12, y".
  [[nodiscard]] std::string name_of(int unknown) const;

 private:
  std::vector<DaeBlock> blocks_;
  int size_ = 0;
};

/// A pattern, and the slots of the entries that were asked for last time: those who ask in the same order
/// again have nothing looked up.
class PatternSlots {
 public:
  void attach(const SparseMatrix& pattern) {  ///< the caller's; what was asked for before is forgotten
    pattern_ = &pattern;
    known_.clear();
  }
  /// Slot of the entry (row, column) that is asked for as the k-th, k = 0, 1, ...; -1 outside the pattern.
  [[nodiscard]] int slot(std::size_t k, int row, int column) {
    if (k < known_.size() && known_[k].row == row && known_[k].column == column) return known_[k].slot;
    if (k >= known_.size()) known_.resize(k + 1);
    known_[k] = {row, column, pattern_->slot(row, column)};
    return known_[k].slot;
  }

 private:
  struct Known {
    int row = -1, column = -1, slot = -1;
  };
  const SparseMatrix* pattern_ = nullptr;
  std::vector<Known> known_;
};

/// Values on a pattern, by row and column, each in the unit of its row over that of its column: of any unit
/// here. What the pattern does not have is left out.
class PatternValues {
 public:
  PatternValues(PatternSlots& slots, std::vector<double>& values) : slots_(slots), values_(values) {}
  /// Adds to the entry (row, column).
  void add(int row, int column, double value) const {
    const int slot = slots_.slot(asked_++, row, column);
    if (slot >= 0) values_[static_cast<std::size_t>(slot)] += value;
  }
  /// A stretch of a column from a row on.
  void add(int first_row, int column, const Eigen::Ref<const Eigen::VectorXd>& stretch) const {
    const auto count = static_cast<int>(stretch.size());
    const int first = slots_.slot(asked_++, first_row, column);
    const int last = slots_.slot(asked_++, first_row + count - 1, column);
    if (first >= 0 && last == first + count - 1) {
      Eigen::Map<Eigen::VectorXd>(values_.data() + first, count) += stretch;
    } else {
      for (int k = 0; k < count; ++k) add(first_row + k, column, stretch[k]);
    }
  }

 private:
  PatternSlots& slots_;
  std::vector<double>& values_;
  mutable std::size_t asked_ = 0;
};

/// Where a residual is wanted: time [s], unknowns and their rates.
struct DaePoint {
  double time = 0.0;
  VectorView y;
  VectorView rate;
};

/// Where Newton's method begins on the way from the last accepted unknowns to those that are predicted for a
/// step.
///                                                                                           theory.md (M.12)
struct IterationStart {
  double share = 1.0;         ///< of the way, in [0, 1]; 1: at its end [-]
  bool out_of_reach = false;  ///< the step has to be shorter: it would go too far behind a touch
};

/// One contributor to F(t, y, y') = 0: it may own unknowns and adds to any row.               theory.md (M.1)
///
/// Order of calls: `declare` once, then the rest; `sparsity` and `attach_pattern` ahead of a `jacobian` that
/// wants another pattern, the first one at least. A part may keep workspace; one part serves one integration
/// at a time. Unknowns, rows and rates are in SI units.
class DaePart {
 public:
  DaePart() = default;
  virtual ~DaePart() = default;
  DaePart(const DaePart&) = delete;
  DaePart& operator=(const DaePart&) = delete;

  /// Appends the part's own blocks.
  virtual void declare(DaeLayout& layout) = 0;
  /// Appends the entries (row, column) of dF/dy and dF/dy' to which the part adds; repeated ones are fine.
  virtual void sparsity(std::vector<std::pair<int, int>>& entries) const = 0;
  /// Appends (p, v) where the row p reads y'_p - y_v = 0, whatever other parts add to it: rates of places.
  virtual void rates(std::vector<std::pair<int, int>>& /*pairs*/) const {}
  /// Told the pattern, to look up its slots in it. It lacks rows and columns of unknowns that are held.
  virtual void attach_pattern(const SparseMatrix& pattern) = 0;
  /// Adds to the rows of F.
  virtual void residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) = 0;
  /// Adds dF/dy + c dF/dy' to the values of the attached pattern.
  virtual void jacobian(const DaePoint& at, double c, std::vector<double>& values) = 0;
  /// Number of functions whose zeros stop the integration.
  [[nodiscard]] virtual int event_count() const { return 0; }
  virtual void events(const DaePoint& /*at*/, std::span<double> /*values*/) {}
  /// Asked before each Jacobian. True: there it has entries that the pattern has not, and `sparsity` lists
  /// them from now on.
  [[nodiscard]] virtual bool outgrows_pattern(const DaePoint& /*at*/) { return false; }
  /// Where on the way from accepted to predicted unknowns Newton's method begins: where what touches does so
  /// as lightly as in the end.
  [[nodiscard]] virtual IterationStart iteration_start(const VectorView& /*from*/, const VectorView& /*to*/) {
    return {};
  }
  /// Told every accepted step.
  virtual void accept(const DaePoint& /*at*/) {}
  /// Appends what the part remembers beside its unknowns, so that `restore_state` puts another part of the
  /// same making into the same state, bit by bit.
  virtual void save_state(std::vector<double>& /*memory*/) const {}
  /// Takes back what `save_state` has appended, from the front of `memory`, at the unknowns `y` that belong
  /// to it.
  virtual void restore_state(const VectorView& /*y*/, std::span<const double>& /*memory*/) {}
};

/// Takes the first number, of any unit, off a memory. Throws InputError when there is none.
[[nodiscard]] double take(std::span<const double>& memory);

/// F(t, y, y') = 0 of several parts on one sparse pattern, in SI units.                       theory.md (M.1)
class DaeSystem {
 public:
  /// The parts stay the caller's and outlive the system.
  explicit DaeSystem(std::vector<DaePart*> parts);

  /// Blocks of all parts, in the order of the parts.
  [[nodiscard]] const DaeLayout& layout() const noexcept { return layout_; }
  /// Number of unknowns, and of rows.
  [[nodiscard]] int size() const noexcept { return layout_.size(); }
  /// Functions whose zeros stop the integration, of all parts together.
  [[nodiscard]] int event_count() const noexcept { return event_count_; }
  /// The matrix of the last `jacobian`; empty before.
  [[nodiscard]] const SparseMatrix& matrix() const noexcept { return matrix_; }

  /// All (p, v) of the parts, see DaePart: of the present pattern.
  [[nodiscard]] const std::vector<std::pair<int, int>>& rates() const noexcept { return rates_; }

  /// From here on these unknowns stay as they are, whatever the parts add to their rows: dy = 0 of each. None
  /// at first.
  void hold(std::vector<int> unknowns);

  /// F into `rows`.
  void residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows);
  /// dF/dy + c dF/dy' into `matrix`; makes the pattern anew first where a part has outgrown it.
  const SparseMatrix& jacobian(const DaePoint& at, double c);
  void events(const DaePoint& at, std::span<double> values);
  /// The first of the starts of all parts on the way.
  [[nodiscard]] IterationStart iteration_start(const VectorView& from, const VectorView& to);
  /// Told every accepted step.
  void accept(const DaePoint& at);
  /// What all parts remember beside their unknowns.
  [[nodiscard]] std::vector<double> memory() const;
  /// Puts the parts into a remembered state. Throws InputError when `memory` is not of these parts.
  void restore_state(const VectorView& y, std::span<const double> memory);
  /// How many times the pattern was made.
  [[nodiscard]] int pattern_version() const noexcept { return pattern_version_; }

 private:
  void make_pattern_anew();
  void leave_out_held(std::vector<std::pair<int, int>>& entries);

  std::vector<DaePart*> parts_;
  DaeLayout layout_;
  SparseMatrix matrix_;
  std::vector<std::pair<int, int>> rates_;
  std::vector<int> held_;
  std::vector<std::size_t> held_slots_;  // of their diagonals
  int event_count_ = 0;
  int pattern_version_ = 0;
  bool stale_pattern_ = true;
};

}  // namespace snare::numerics
