#include "host/requests/run_answers.hpp"

#include <fmt/format.h>

#include "firmware/machine/file/machine_file.hpp"
#include "host/log/read_log.hpp"
#include "host/output/experiment_output.hpp"
#include "host/requests/cam_run_request.hpp"
#include "host/requests/replay_request.hpp"
#include "host/requests/request_texts.hpp"
#include "host/requests/response_request.hpp"
#include "host/requests/usage_error.hpp"

namespace stiction::host {
namespace {

constexpr std::uint64_t most_cycles = 1000;      // of a master, as the command's
constexpr std::uint64_t most_periods = 1000000;  // of a test signal: more than any record holds

std::function<void(const std::string&)> told(const RequestProgress& progress) {
  return [&progress](const std::string& label) {
    if (progress) progress(label);
  };
}

}  // namespace

RequestAnswer answer_cam(const Request& request, const RequestProgress& progress) {
  const RequestTexts texts(request);
  CamRunRequest cam{.motion = texts.text("cam"), .name = texts.text("name"), .speed = texts.text("speed")};
  cam.axis = texts.text("axis");
  cam.master = texts.text("master", cam.master);
  cam.cycles = static_cast<int>(texts.number("cycles", static_cast<std::uint64_t>(cam.cycles), 1, most_cycles));
  cam.model = texts.text("model");
  cam.verification = texts.flag("verification");
  for (const auto& [option, value] : {std::pair{"cam", cam.motion}, std::pair{"speed", cam.speed}})
    if (value.empty() && !cam.verification)
      throw UsageError(fmt::format("--{}: found none; expected one, as the cam has no usual one", option));
  auto found = cam_run_request(
      cam, {.load = [&](const auto& needs) { return machine_of(request, "", needs); }, .done = told(progress)});
  RequestAnswer answer{experiment_json(found.result, found.machine)};
  if (request.keep_logs)
    for (auto& each : found.logs) answer.logs.push_back({each.name, std::move(each.log)});
  return answer;
}

RequestAnswer answer_replay(const Request& request, const RequestProgress& progress) {
  const RequestTexts texts(request);
  if (request.logs.size() != 1)
    throw UsageError(fmt::format("{}: found {} logs; expected one", request.command, request.logs.size()));
  auto replayed =
      replay_request({{request.machine},
                      request.logs.front(),
                      texts.text("columns"),
                      texts.text("friction"),
                      texts.text("axis"),
                      texts.text("signals", "fixed")},
                     {.load = [&](const auto&, const auto& needs) { return machine_of(request, "replay", needs); },
                      .running = told(progress)});
  RequestAnswer answer{experiment_json(replayed.result, replayed.cases.front().machine)};
  if (request.keep_logs)
    for (auto& each : replayed.cases) answer.logs.push_back({each.label, std::move(each.simulated)});
  return answer;
}

RequestAnswer answer_response(const Request& request, const RequestProgress& progress) {
  const RequestTexts texts(request);
  if (request.logs.size() > 1)
    throw UsageError(fmt::format("{}: found {} logs; expected one, or none", request.command, request.logs.size()));
  const bool measured = !request.logs.empty();
  ResponseRequest response{.axis = texts.text("axis"), .loop = texts.text("loop"), .columns = texts.text("columns")};
  if (measured) {
    response.from = request.logs.front();
    if (request.keep_logs)
      throw UsageError(fmt::format("{}: found that logs are wanted and a log; expected one of them", request.command));
    for (const char* option : {"friction", "signal", "speed", "amplitude", "lowest", "periods", "passes"})
      if (!texts.text(option).empty())
        throw UsageError(fmt::format("--{}: found it with a log; expected it of a simulated test alone", option));
  } else if (!response.columns.empty()) {
    throw UsageError("--columns: found it without a log; expected it with one");
  }
  response.friction = texts.text("friction");
  response.signal = texts.text("signal", response.signal);
  response.speed = texts.text("speed");
  response.amplitude = texts.text("amplitude");
  response.lowest = texts.text("lowest", response.lowest);
  const auto whole = [&](const char* option, int usual) {
    return static_cast<int>(texts.number(option, static_cast<std::uint64_t>(usual), 0, most_periods));
  };
  response.periods = whole("periods", response.periods);
  response.passes = whole("passes", response.passes);
  RequestAnswer answer;
  ResponseHooks hooks{.read = [](const auto& file, const auto& columns) { return read_log(file, {columns, {}}); }};
  hooks.simulated = [&](const Log& log) {
    if (request.keep_logs) answer.logs.push_back({"test", log});
    if (progress) progress("simulated");
  };
  const auto found =
      response_request(response, machine_of(request, "frequency-response", needs_of("frequency-response")),
                       machine::find_machine(request.machine), hooks);
  answer.document = experiment_json(found.result, found.machine);
  return answer;
}

}  // namespace stiction::host
