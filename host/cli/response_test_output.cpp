#include "host/cli/response_test_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "host/cli/errors.hpp"
#include "host/log/log.hpp"
#include "host/log/text_source.hpp"
#include "host/response/axis_response.hpp"
#include "host/response/response_test.hpp"

namespace stiction::host {
namespace {

using Object = nlohmann::ordered_json;

double decibels(const TestResponsePoint& point) { return 20.0 * std::log10(std::abs(point.gain)); }
double degrees(const TestResponsePoint& point) { return std::arg(point.gain) * 180.0 / std::numbers::pi; }

Object points_json(const std::vector<TestResponsePoint>& points) {
  Object out = Object::array();
  for (const auto& point : points)
    out.push_back({{"frequency_Hz", point.frequency},
                   {"real", point.gain.real()},
                   {"imaginary", point.gain.imag()},
                   {"coherence", point.coherence}});
  return out;
}

Object test_json(const ResponseTest& test, const std::vector<TestResponsePoint>& ours,
                 const std::vector<TestResponsePoint>& stored, const ResponseDifference& difference) {
  const auto& input = test.signals[test.input];
  return {{"schema", "stiction.response-test/1"},
          {"source", test.source},
          {"software", test.software},
          {"date", test.date},
          {"axis", test.axis},
          {"rotary_axis", test.rotary},
          {"linear_motor", test.linear_motor},
          {"motor_to_axis_ratio", test.motor_to_axis},
          {"motor_force_constant", test.force_constant},
          {"sampling_interval_s", test.sampling},
          {"bandwidth_Hz", test.bandwidth},
          {"excitation", {{"offset", test.offset}, {"amplitude", test.amplitude}, {"prbs_order", test.prbs_order}}},
          {"records", input.records.size()},
          {"samples", input.records.front().size()},
          {"difference",
           {{"least_coherence", least_coherence},
            {"lines", difference.lines},
            {"gain_dB", difference.gain_db},
            {"phase_deg", difference.phase_deg}}},
          {"computed", points_json(ours)},
          {"stored", points_json(stored)}};
}

std::string test_text(const ResponseTest& test, const std::vector<TestResponsePoint>& ours,
                      const std::vector<TestResponsePoint>& stored, const ResponseDifference& difference) {
  const auto& input = test.signals[test.input];
  std::string text = fmt::format(
      "{}: response test of axis {} on {}, software {}\n"
      "  {} axis, {} motor; {} records of {} samples at {:.6g} ms; excitation {:.4g} ± {:.4g} in the units of the "
      "file\n"
      "  response: signal {} over signal {}, computed from the time series\n\n"
      "  frequency       gain      phase  coherence   stored gain  stored phase\n",
      test.source, test.axis, test.date, test.software, test.rotary ? "rotary" : "linear",
      test.linear_motor ? "linear" : "rotary", input.records.size(), input.records.front().size(), input.period * 1e3,
      test.offset, test.amplitude, test.signals[test.output].node, input.node);
  double next = 0.0;
  for (std::size_t k = 1; k < stored.size(); ++k) {
    if (ours[k].frequency < next) continue;
    next = ours[k].frequency * 1.25;
    text +=
        fmt::format("{:>8.1f} Hz {:>7.2f} dB {:>8.1f}° {:>10.3f} {:>10.2f} dB {:>12.1f}°\n", ours[k].frequency,
                    decibels(ours[k]), degrees(ours[k]), ours[k].coherence, decibels(stored[k]), degrees(stored[k]));
  }
  text += fmt::format(
      "\nThe stored response differs from it by at most {:.2g} dB and {:.2g}° on the {} of {} lines whose coherence is "
      "above {:g}.\n",
      difference.gain_db, difference.phase_deg, difference.lines, stored.size(), least_coherence);
  // The control labels its lines with a spacing of its own.
  const double highest = ours[stored.size() - 1].frequency;
  const double label = highest > 0.0 ? stored.back().frequency / highest - 1.0 : 0.0;
  if (std::abs(label) > 1e-6)
    text += fmt::format(
        "The frequencies here are multiples of 1/(N T) = {:.6g} Hz, as the records are; those written in the file are "
        "{:.2g} % {}.\n",
        ours[1].frequency, std::abs(label) * 100.0, label > 0.0 ? "higher" : "lower");
  return text;
}

}  // namespace

bool is_response_test_file(const std::string& file) {
  try {
    return is_response_test(first_bytes(file, 4096));
  } catch (const LogError&) {
    return false;
  }
}

void print_response_test(const std::string& file, bool as_json) {
  try {
    const auto test = parse_response_test(read_plain_or_gzip(file, "a response test"), file);
    const auto ours = computed_response(test), stored = stored_response(test);
    const auto difference = compare_responses(ours, stored, least_coherence);
    if (as_json)
      fmt::print("{}\n", test_json(test, ours, stored, difference).dump(2));
    else
      fmt::print("{}", test_text(test, ours, stored, difference));
  } catch (const ResponseTestError& error) {
    throw UsageError(error.what());
  } catch (const LogError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace stiction::host
