#include "proto/wire/fit.h"

#include "proto/wire/audit.h"
#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/scene.h"

namespace ricochet {

RICOCHET_MAP(FitUnknown, path, start, low, high);
RICOCHET_MAP(FitInput, path, values, sigma);
RICOCHET_MAP(FitMeasured, path, values, sigma);
RICOCHET_MAP(FitRequest, scene, unknowns, inputs, measured, loss, loss_scale, starts, max_iterations, region);
RICOCHET_MAP(FitEnd, kind, value);
RICOCHET_MAP(FitProfilePoint, value, rise);
RICOCHET_MAP(FitEstimate, path, value, seen, sigma, low, high, profile, row_shares);
RICOCHET_MAP(FitRow, regime, predicted, residuals, broken_limits);
RICOCHET_MAP(FitOutlier, row, path, residual);
RICOCHET_MAP(FitStart, from, to, objective, iterations, converged);
RICOCHET_MAP(FitThreshold, row, of, by, from_below, from_above);
RICOCHET_MAP(FitRegionPoint, x, y, kind);
RICOCHET_MAP(FitResponse, unknowns, covariance, correlation, rows, outliers, objective, interval_rise, chi2,
             degrees_of_freedom, p_value, refused, starts, starts_differ, thresholds, region, exact_derivatives,
             why_differences, notes, engine);

RICOCHET_CONVERT(FitRequest);
RICOCHET_CONVERT(FitResponse);

}  // namespace ricochet
