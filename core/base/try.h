// RICOCHET_TRY(const Scene scene, ReadScene(options)) sets its first part, which may declare what it sets, to the value
// of an absl::StatusOr, or returns the error from the function around it. It is several statements, so that it cannot
// stand alone behind an `if` without braces.

#ifndef RICOCHET_CORE_BASE_TRY_H_
#define RICOCHET_CORE_BASE_TRY_H_

#include <utility>

#define RICOCHET_TRY(target, ...) RICOCHET_TRY_AS(RICOCHET_TRY_JOIN(value_or_, __LINE__), target, __VA_ARGS__)
#define RICOCHET_TRY_AS(value_or, target, ...)  \
  auto value_or = __VA_ARGS__;                  \
  if (!value_or.ok()) return value_or.status(); \
  target = *std::move(value_or)
// Two steps, so that __LINE__ is replaced by its number before it is joined.
#define RICOCHET_TRY_JOIN(a, b) RICOCHET_TRY_PASTE(a, b)
#define RICOCHET_TRY_PASTE(a, b) a##b

#endif  // RICOCHET_CORE_BASE_TRY_H_
