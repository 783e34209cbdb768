// Branches: decides which way a computation goes by proof, or takes both ways in turn.
//
// The sign of a Surd is always known. The sign of an ArfInterval that holds 0 is not, and the branch is then open.
// While more precision may help, the caller throws such a run away. At the highest precision it repeats the computation
// once for each combination of open branches, and the answers together enclose the right one.

#ifndef RICOCHET_CORE_CERTIFIED_BRANCHES_H_
#define RICOCHET_CORE_CERTIFIED_BRANCHES_H_

#include <cstddef>
#include <vector>

#include "core/certified/arf_interval.h"
#include "core/certified/surd.h"

namespace ricochet::certified {

class Branches {
 public:
  // Takes an open branch: it answers no in the first run, and yes once NextRun has turned it.
  bool TakeOpen() {
    if (next_ == taken_.size()) taken_.push_back(false);
    return taken_[next_++];
  }

  // Tells whether some branch of the run was open.
  bool any_open() const { return !taken_.empty(); }

  // Prepares a run that turns the last open branch not yet turned. Returns false if there is none.
  bool NextRun() {
    taken_.resize(next_);
    while (!taken_.empty() && taken_.back()) taken_.pop_back();
    next_ = 0;
    if (taken_.empty()) return false;
    taken_.back() = true;
    return true;
  }

 private:
  std::vector<bool> taken_;
  size_t next_ = 0;
};

inline bool IsNegative(const Surd& x, Branches& /*branches*/) { return x.Sign() < 0; }
inline bool IsPositive(const Surd& x, Branches& /*branches*/) { return x.Sign() > 0; }

inline bool IsNegative(const ArfInterval& x, Branches& branches) {
  if (x.upper().Sign() < 0) return true;
  return x.lower().Sign() < 0 && branches.TakeOpen();
}
inline bool IsPositive(const ArfInterval& x, Branches& branches) { return IsNegative(-x, branches); }

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_BRANCHES_H_
