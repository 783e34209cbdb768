// The columns of AuditColumns by their names, other than the rates, which are a list of columns.

#ifndef RICOCHET_AUDIT_COLUMNS_H_
#define RICOCHET_AUDIT_COLUMNS_H_

#include <vector>

#include "ricochet/audit.h"

namespace ricochet {

// The kind of number that a column states, which decides whether a request must have it.
enum class AuditColumnPart {
  kBefore,  // The velocity before the impact: that of the scene where it is not stated.
  kAfter,   // The velocity after the impact: it is stated here or by the rates.
  kOption,  // May be left out.
};

struct NamedAuditColumn {
  const char* name;
  std::vector<double> AuditColumns::*values;
  AuditColumnPart part;
  bool is_spatial = false;  // True if only a system in space has it.
};

inline constexpr NamedAuditColumn kAuditColumns[] = {
    {"tangential_m_s", &AuditColumns::tangential_m_s, AuditColumnPart::kBefore},
    {"tangential_2_m_s", &AuditColumns::tangential_2_m_s, AuditColumnPart::kBefore, /*is_spatial=*/true},
    {"normal_m_s", &AuditColumns::normal_m_s, AuditColumnPart::kBefore},
    {"tangential_after_m_s", &AuditColumns::tangential_after_m_s, AuditColumnPart::kAfter},
    {"tangential_2_after_m_s", &AuditColumns::tangential_2_after_m_s, AuditColumnPart::kAfter, /*is_spatial=*/true},
    {"normal_after_m_s", &AuditColumns::normal_after_m_s, AuditColumnPart::kAfter},
    {"friction", &AuditColumns::friction, AuditColumnPart::kOption},
    {"velocity_uncertainty_m_s", &AuditColumns::velocity_uncertainty_m_s, AuditColumnPart::kOption},
};

}  // namespace ricochet

#endif  // RICOCHET_AUDIT_COLUMNS_H_
