// ScaleFor: the ends of an axis or of a scale of colours, from the numbers alone, such that they show most of the
// numbers well. Maps and lines share this one rule.
//
// All values lie inside, but for a few far beyond the rest. The middle part is the shortest interval that holds the
// values of every group but a twentieth of them, rounded up, on each side; of fewer than 10 values it holds all. So no
// curve is lost because others are smaller. If values beyond one end of the middle part reach further than four times
// its length, they would squeeze it into a fifth of the scale: the scale then ends at the last value within a quarter
// of its length, rounded outwards to two digits. A middle part whose length is rounding, beside its own values or the
// region of others that would be left out, moves no end.
//
// The scale is logarithmic if that is asked for, or if all values are > 0 and a third of them would lie in the lowest
// thirtieth of a linear one without a few of the largest. Lengths are then those of the logarithms.

#ifndef RICOCHET_CLIENT_CLI_PLOT_PLOT_SCALE_H_
#define RICOCHET_CLIENT_CLI_PLOT_PLOT_SCALE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "client/cli/plot/plot_axis.h"

namespace ricochet::cli {

struct Scale {
  bool any = false;  // Whether there is a finite value that the scale can show; else it ends at 1 and 10.
  bool log = false;
  double least = 1.0;  // The ends.
  double most = 10.0;
  int64_t count = 0;  // Values in all.
  int64_t below = 0;  // Values beyond the ends, and the outermost of them, which may be infinite.
  int64_t above = 0;
  double lowest = 1.0;
  double highest = 10.0;
  friend bool operator==(const Scale&, const Scale&) = default;
};

// NaN is no value. A logarithmic scale that is asked for ignores values <= 0, which it cannot show.
Scale ScaleFor(std::vector<std::vector<double>> groups, bool log_asked);

// Returns the range of an axis on this scale, as RangeFor does; there is no margin at an end that values lie beyond.
AxisRange RangeOf(const Scale& scale, double margin, double noise);

// Returns the ticks of that range with a mark such as "≥ 5.2" at each end that values lie beyond, in place of the
// ticks beside it. `room` is what a label takes of the length of the axis, as a fraction.
std::vector<Tick> WithMarkedEnds(std::vector<Tick> ticks, const Scale& scale, const AxisRange& range, double room);

// Returns how many points lie beyond the ends and how far, such as "7 of 6561 points lie above 5.2, up to 1670"; empty
// if there are none.
std::string OutsideText(const Scale& scale);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_PLOT_SCALE_H_
