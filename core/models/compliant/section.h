// SectionMode and SectionEnd: what a section of a compliant path keeps fixed, and what ends it.
//
// A section is a stretch of one friction state, on one branch of the normal spring, in one direction of v.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_SECTION_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_SECTION_H_

#include "core/models/compliant/spring_contact.h"

namespace ricochet::compliant {

struct SectionMode {
  LoadingBranch branch = LoadingBranch::kFirstLoading;
  bool indenting = true;              // v < 0; always true on first loading.
  int slip_side = 0;                  // 1 or -1 while the particle slides, 0 while it sticks.
  int left_cone_side = 0;             // A stick that begins on this side of the friction cone moves off it at once.
  bool begins_with_v_zero = false;    // v = 0 at the start is not the end of the section.
  double largest_normal_force = 0.0;  // N at the largest indentation so far; not used on first loading.

  bool IsFirstLoading() const { return branch == LoadingBranch::kFirstLoading; }
  bool Sticks() const { return slip_side == 0; }
};

// Several events may coincide.
struct SectionEnd {
  bool turns = false;           // v = 0.
  bool stops = false;           // The particle stops.
  int breaks_away = 0;          // The particle begins to slide towards this side.
  bool passes_largest = false;  // The indentation exceeds its largest value so far.
  bool parts = false;           // N = 0.
  bool has_no_end = false;      // The section goes on for ever, or the search for its end gave up.
  bool overflows = false;       // Nothing is known of the end.
};

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_SECTION_H_
