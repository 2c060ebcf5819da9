// The result of `stiction cam step` for a single cam with a spring, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "host/cam/step/spring_cam.hpp"

namespace stiction::host {

// "stiction.cam-spring/1" of `made`, which is of `project`; `files`: names and CRC-32 of those that were written.
nlohmann::ordered_json spring_json(const step::StepProject& project, const step::SpringCam& made,
                                   const std::vector<std::pair<std::string, std::string>>& files);

// The same figures of `made`, which is of `project`, as text.
std::string spring_text(const step::StepProject& project, const step::SpringCam& made);

}  // namespace stiction::host
