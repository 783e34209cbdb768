// CheckInvariant: stops the process with a message if the code itself is wrong.
//
// Every build checks it. It is for conditions that no input can cause; a bad request is an absl::Status
// (ricochet/error.h).

#ifndef RICOCHET_CORE_BASE_INVARIANT_H_
#define RICOCHET_CORE_BASE_INVARIANT_H_

namespace ricochet {

// Prints `message` with its place to standard error and aborts.
[[noreturn]] void StopOnBrokenInvariant(const char* message, const char* file, int line);

inline void CheckInvariant(bool holds, const char* message, const char* file = __builtin_FILE(),
                           int line = __builtin_LINE()) {
  if (!holds) StopOnBrokenInvariant(message, file, line);
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_INVARIANT_H_
