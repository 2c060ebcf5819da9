// The studio as the page calls it: a text and numbers in, a status, a text and a table of numbers out.
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/studio/number_check.hpp"
#include "host/studio/studio.hpp"

namespace {

using stiction::host::Studio;
using stiction::host::StudioRun;
using stiction::host::StudioTable;

// In the order of CALLS in web/engine.js.
enum class Call : std::int32_t {
  load_motion,
  load_machine,
  edit,
  undo,
  redo,
  motion_text,
  state,
  laws,
  law_curve,
  curves,
  harmonics,
  follow,
  shaft,
  numbers,
  formats,
  exported,
  methods,
  shape,
  choose_cam,
  load_step,
  new_step,
  step_text,
  step_number,
  step_choice,
  relief,
  step_state,
  step_figures,
  step_profiles,
  step_contacts,
  step_turn,
  step_files
};

struct Answer {
  std::string text;
  StudioTable table;
  StudioTable record;
};

std::string input;
std::unique_ptr<Studio> studio;
Answer answer;

// Two texts with a zero between them.
std::pair<std::string, std::string> two_texts() {
  const auto end = input.find('\0');
  return {input.substr(0, end), end == std::string::npos ? std::string() : input.substr(end + 1)};
}

void take(StudioRun run) {
  const auto optional = [](const std::optional<double>& value) { return value.value_or(-1.0); };
  answer.record = std::move(run.record);
  answer.table = std::move(run.ticks);
  // Behind the ticks.
  for (const double figure : {run.peak_error, run.mean_error, run.peak_effort, run.rms_effort, run.motor_error,
                              optional(run.dwell), optional(run.dwell_area)})
    answer.table.values.push_back(figure);
}

// Files one behind the other in the order of a list, each of its name's length and its own, both counted in bytes.
void take(const std::vector<stiction::host::step::ShopFile>& files) {
  answer.table.columns = 2;
  for (const auto& [name, text] : files) {
    answer.text += name + text;
    answer.table.values.insert(answer.table.values.end(),
                               {static_cast<double>(name.size()), static_cast<double>(text.size())});
  }
}

void serve(Call call, std::size_t at, double x, double y, std::int32_t flag) {
  if (!studio) studio = std::make_unique<Studio>();
  switch (call) {
    case Call::load_motion: {
      const auto [file, text] = two_texts();
      return studio->load_motion(file, text);
    }
    case Call::load_machine: {
      const auto [file, text] = two_texts();
      return studio->load_machine(file, text);
    }
    case Call::edit: {
      const auto [verb, key] = two_texts();
      return studio->edit({.verb = verb, .at = at, .key = key, .x = x, .y = y, .goes_on = flag != 0});
    }
    case Call::undo:
      studio->undo();
      return;
    case Call::redo:
      studio->redo();
      return;
    case Call::motion_text:
      answer.text = studio->motion_text();
      return;
    case Call::state:
      answer.text = studio->state_json(x);
      return;
    case Call::laws:
      answer.text = Studio::laws_json();
      return;
    case Call::law_curve:
      answer.table = Studio::law_curve(at);
      return;
    case Call::curves:
      answer.table = studio->curves(x, at);
      return;
    case Call::harmonics:
      answer.table = {1, studio->harmonics(at)};
      return;
    case Call::follow:
      return take(studio->follow(x, flag));
    case Call::shaft:
      return take(studio->stand(x, flag, y));
    case Call::numbers:
      answer.table = {1, stiction::host::number_values(static_cast<stiction::host::NumberFunction>(flag), at)};
      return;
    case Call::formats:
      answer.text = Studio::formats_json();
      return;
    case Call::methods:
      answer.text = Studio::methods_json();
      return;
    case Call::shape:
      return studio->shape(two_texts().first, x);
    case Call::exported:
      answer.text = studio->exported_file(two_texts().first);
      return;
    case Call::choose_cam:
      return studio->choose_cam(at);
    case Call::load_step: {
      const auto [file, text] = two_texts();
      return studio->load_step(file, text);
    }
    case Call::new_step:
      return studio->new_step();
    case Call::step_text:
      answer.text = studio->step_text();
      return;
    case Call::step_number:
      return studio->set_step_number(two_texts().first, flag != 0 ? std::optional(x) : std::nullopt);
    case Call::step_choice: {
      const auto [name, value] = two_texts();
      return studio->set_step_choice(name, value);
    }
    case Call::relief: {
      // `x`: of the depth or the blend, as the text says; the lowest bit of `flag`: it goes on, the next one: alone.
      stiction::host::ReliefStep step{.arc = at, .alone = (flag & 2) != 0};
      (two_texts().first == "depth" ? step.depth : step.blend) = x;
      return studio->set_relief(step, (flag & 1) != 0);
    }
    case Call::step_state:
      answer.text = studio->step().state_json();
      return;
    case Call::step_figures:
      answer.text = studio->step().figures_json();
      return;
    case Call::step_profiles:
      answer.table = studio->step().profiles();
      return;
    case Call::step_contacts:
      answer.table = studio->step().contacts();
      return;
    case Call::step_turn:
      answer.table = studio->step().turn();
      return;
    case Call::step_files:
      return take(studio->step().files(two_texts().first));
  }
}

}  // namespace

#define STICTION_EXPORT(name) extern "C" __attribute__((export_name(#name)))

// Room for a text of `size` bytes, which the next call reads.
STICTION_EXPORT(studio_input) char* studio_input(std::size_t size) {
  input.assign(size, '\0');
  return input.data();
}

// 0: done; 1: the text says what was found and expected.
STICTION_EXPORT(studio_call)
std::int32_t studio_call(std::int32_t call, std::size_t at, double x, double y, std::int32_t flag) {
  answer = {};
  try {
    serve(static_cast<Call>(call), at, x, y, flag);
    return 0;
  } catch (const std::exception& error) {
    answer.text = error.what();
  } catch (...) {
    answer.text = "found an error without a name; expected none";
  }
  return 1;
}

STICTION_EXPORT(studio_text) const char* studio_text() { return answer.text.data(); }
STICTION_EXPORT(studio_text_size) std::size_t studio_text_size() { return answer.text.size(); }
STICTION_EXPORT(studio_table) const double* studio_table() { return answer.table.values.data(); }
STICTION_EXPORT(studio_table_size) std::size_t studio_table_size() { return answer.table.values.size(); }
STICTION_EXPORT(studio_record) const double* studio_record() { return answer.record.values.data(); }
STICTION_EXPORT(studio_record_size) std::size_t studio_record_size() { return answer.record.values.size(); }
