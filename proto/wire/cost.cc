#include "proto/wire/cost.h"

#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/scene.h"

namespace ricochet {

RICOCHET_MAP(CostRequest, scene, time_limit_s, samples, multi_contact);
RICOCHET_MAP(CostMethod, model, arithmetic, tolerance, digits, stiffness, multi_contact);
RICOCHET_MAP(CostTime, median_s, lower_quartile_s, upper_quartile_s, samples, per_sample);
RICOCHET_MAP(CostError, total, numerical, modelling);
RICOCHET_MAP(CostRow, name, method, status, note, solve, batch, batch_in_lanes, claimed, achieved, reference_error,
             velocity_after, steps, right_hand_sides);
RICOCHET_MAP(CostPick, row, least_tolerance, most_tolerance, model);
RICOCHET_MAP(CostMachine, cpu, compiler, simd_target, optimized);
RICOCHET_MAP(CostSummary, reference, reference_source, reference_error, front, picks, deceived, out_of_time, failed,
             machine, elapsed_s);
RICOCHET_MAP_AS(CostChunk, v1::CostResponse, first_row, rows, rows_done, rows_total, summary, engine);

RICOCHET_CONVERT(CostRequest);
RICOCHET_CONVERT(CostChunk);

}  // namespace ricochet
