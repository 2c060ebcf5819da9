// The results of `stiction cam` as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/cam/duty.hpp"
#include "host/cam/rank.hpp"
#include "sim/cam/check.hpp"
#include "sim/cam/laws.hpp"

namespace stiction::host {

// Natural periods in the rise at which the residual amplitude of each law is listed.
inline constexpr double listed_periods[] = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0};

// "stiction.cam-laws/1", and a line for each law. `laws`: those to show.
nlohmann::ordered_json laws_json(const std::vector<const sim::cam::Law*>& laws);
std::string laws_text(const std::vector<const sim::cam::Law*>& laws);

// What a check found of one cam.
struct CamCheck {
  sim::cam::Motion motion;
  std::vector<sim::cam::MotionJump> jumps;
  std::optional<Duty> duty{};      // at the speed that was asked for
  std::optional<AxisLoad> load{};  // of the machine

  // Whether position or speed jumps, or a limit is broken.
  bool failed() const;
};

// "stiction.cam-check/1"; `motion`: the name of the file; and as text.
nlohmann::ordered_json check_json(const std::string& motion, const std::vector<CamCheck>& checks);
std::string check_text(const CamCheck& check);

// "stiction.cam-rank/1", and as text. `ranking` of `task` on the axis of `load`.
nlohmann::ordered_json rank_json(const Ranking& ranking, const RankTask& task, const AxisLoad& load);
std::string rank_text(const Ranking& ranking, const RankTask& task, const AxisLoad& load);

}  // namespace stiction::host
