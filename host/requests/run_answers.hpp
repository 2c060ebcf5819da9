// Answers to requests for runs that are neither circles nor experiments of the table: cams, replays, frequency
// responses.
#pragma once

#include "host/requests/request.hpp"

namespace stiction::host {

// Each as answer(): the document of the command `request` names, and the logs of its runs where they are to be kept.
// `progress` is told each run.
RequestAnswer answer_cam(const Request& request, const RequestProgress& progress);
RequestAnswer answer_replay(const Request& request, const RequestProgress& progress);
RequestAnswer answer_response(const Request& request, const RequestProgress& progress);

}  // namespace stiction::host
