#pragma once

#include "json.hpp"

#include "vigia/evaluation/drive_score.hpp"

namespace vigia::evaluation {

/// The parts of summary.json.
Json loss_json(const LossScore& score);
Json localizer_json(const LocalizerScore& score);
Json perception_json(const PerceptionScore& score);
Json recovery_json(const RecoveryScore& score);

/// What a score's record holds.
DriveScore score_from_json(const Json& record);

}  // namespace vigia::evaluation
