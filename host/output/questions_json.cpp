#include "host/output/questions_json.hpp"

namespace stiction::host {
namespace {

const char* question_kind(const Question& question) {
  switch (question.about) {
    case Question::About::amperes:
      return "amperes";
    case Question::About::length:
      return "length";
    case Question::About::angle:
      return "angle";
    case Question::About::sign:
      return "sign";
    case Question::About::shift:
      return "shift";
    case Question::About::scale:
      return "scale";
  }
  return "";
}

}  // namespace

nlohmann::ordered_json questions_json(const std::vector<Question>& questions) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& q : questions)
    list.push_back({{"about", question_kind(q)},
                    {"question", q.text},
                    {"value", q.value},
                    {"ci95", {q.low, q.high}},
                    {"probability", q.probability}});
  return list;
}

}  // namespace stiction::host
