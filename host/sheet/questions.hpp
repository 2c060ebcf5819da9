// The questions that make a machine file of data sheets, in the order in which they are asked: each is a flag, too. One
// table: flags, prompts, help and checks come from it.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace stiction::host {

// What was answered, as it was written, by the name of the question ("load").
using SheetAnswers = std::map<std::string, std::string, std::less<>>;

struct SheetQuestion {
  std::string_view name;  // of the flag, without its dashes
  std::string_view text;
  std::string_view unit;                  // SI, of a quantity; empty: a text, a whole number or one of the choices
  std::string_view rotary_unit;           // of a rotary axis, where it differs; else empty
  std::vector<std::string_view> choices;  // empty: any
  std::string_view fallback;              // empty: it must be answered
  bool (*wanted)(const SheetAnswers&);    // whether it makes sense after the answers before
  std::string_view of_source{};           // the fallback of a motor that is a source of force; empty: the one above
};
std::span<const SheetQuestion> sheet_questions();

// Whether drive and motor are one source of force, and whether volts drive it, not amperes.
bool is_force_source(const SheetAnswers& answers);
bool driven_by_volts(const SheetAnswers& answers);

// Whether the question may stay open after the `answers`: it has a fallback, or none is needed.
bool may_stay_open(const SheetQuestion& question, const SheetAnswers& answers);

// What `answers` say to the question `name`, or its fallback; empty where it is open.
std::string answer_to(const SheetAnswers& answers, std::string_view name);

// The unit that a question has after the answers.
std::string_view unit_of(const SheetQuestion& question, const SheetAnswers& answers);

// What is wrong with an `answer` to the `question` after the `answers` before, as "found ...; expected ..."; empty
// where nothing is.
std::string objection_to(const SheetQuestion& question, const std::string& answer, const SheetAnswers& answers);

// The quantity in `unit` that `answers` give to the question `name`; it passed objection_to().
double sheet_quantity(const SheetAnswers& answers, std::string_view name, std::string_view unit);

// The value of "3" or "355/113"; 0 for what is no positive ratio. `text`: an answer.
double ratio_in(std::string_view text);

}  // namespace stiction::host
