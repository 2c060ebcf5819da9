#include "host/response/response_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <pugixml.hpp>
#include <unsupported/Eigen/FFT>

#include "host/log/message.hpp"

namespace stiction::host {
namespace {

constexpr double largest_value = 1e70;  // the square of a spectrum, a product of four, stays in the range of double

constexpr std::string_view digits_85 =
    "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ!#$`()*+-/:;=?@[]^_{|}~";

constexpr std::array<std::int8_t, 256> values_of_digits() {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t k = 0; k < digits_85.size(); ++k)
    values[static_cast<unsigned char>(digits_85[k])] = static_cast<std::int8_t>(k);
  return values;
}
constexpr auto digit_values = values_of_digits();

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text) { test_.source = name; }

  ResponseTest read() {
    const auto parsed = document_.load_buffer(text_.data(), text_.size());
    if (!parsed)
      throw ResponseTestError(fmt::format("{}:{}: found no valid XML ({}); expected a response test of a SINUMERIK",
                                          test_.source, line_of(parsed.offset), parsed.description()));
    const auto root = document_.document_element();
    if (!std::string_view(root.name()).starts_with("ResponseTest"))
      fail(root, fmt::format("the element <{}>", excerpt(root.name())), "a response test of a SINUMERIK");
    test_.software = root.attribute("ver").value();
    test_.date = named(named(root, "SatTimeStamp", "m_timeStampMeas"), "unsigned_int", "Date").text().get();
    test_.axis = named(root, "unsigned_int", "m_uAxis").text().as_uint();
    for (const auto node : named(root, "LinkedList", "m_MeasurementSignalNodeList").children("PlatformSignalNode"))
      read_signal(node);
    if (test_.signals.size() < 2)
      fail(root, fmt::format("{} measured signals", test_.signals.size()), "an input and an output");
    read_excitation(named(root, "LinkedList", "m_ExcitationSourceList").child("ExcitationSource"));
    const auto conditions = named(root, "LinkedList", "m_listpResponseTestConditions").child("ResponseTestCondition");
    test_.sampling = number(conditions, "m_dSamplingInterval");
    test_.bandwidth = number(conditions, "m_dBandwidth");
    test_.settling = number(conditions, "m_dSettlingTime");
    read_roles(root);
    return std::move(test_);
  }

 private:
  std::size_t line_of(std::ptrdiff_t offset) const {
    const auto count = std::min(text_.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, offset)));
    return 1 + static_cast<std::size_t>(std::ranges::count(text_.substr(0, count), '\n'));
  }

  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& found, const std::string& expected) const {
    throw ResponseTestError(
        fmt::format("{}:{}: found {}; expected {}", test_.source, line_of(node.offset_debug()), found, expected));
  }

  static pugi::xml_node named(const pugi::xml_node& parent, const char* element, const char* name) {
    return parent.find_child([&](const pugi::xml_node& child) {
      return std::string_view(child.name()) == element && std::string_view(child.attribute("name").value()) == name;
    });
  }

  // 0 where it is not there.
  double number(const pugi::xml_node& parent, const char* name) const {
    const auto node = named(parent, "float", name);
    if (!node) return 0.0;
    const std::string_view text = node.text().get();
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
      fail(node, fmt::format("{} = '{}'", name, excerpt(text)), "a finite number");
    return value;
  }

  std::vector<double> array(const pugi::xml_node& parent, const char* name, std::size_t doubles_each) const {
    const auto node = named(parent, "NumericArray", name);
    if (!node) fail(parent, fmt::format("no array {}", name), "its numbers");
    if (std::string_view(node.attribute("format").value()) != "base85")
      fail(node, fmt::format("an array in the format '{}'", excerpt(node.attribute("format").value())), "base85");
    const auto length = named(node, "unsigned_int", "m_length").text().as_ullong();
    const auto raw = node.child("raw");
    std::vector<double> values;
    try {
      values = base85_doubles(raw.text().get());
    } catch (const std::invalid_argument& error) {
      fail(raw, error.what(), "digits to the base 85");
    }
    if (values.size() != length * doubles_each)
      fail(node, fmt::format("{} numbers in {}", values.size(), name),
           fmt::format("{}, as m_length is {}", length * doubles_each, length));
    for (const double value : values)
      if (!(std::abs(value) < largest_value))
        fail(node, fmt::format("{} in {}", value, name), fmt::format("numbers below {:g}", largest_value));
    return values;
  }

  StoredSpectrum spectrum(const pugi::xml_node& info, unsigned of) const {
    const auto data = info.child("CrossSpectrum");
    if (!data) fail(info, "no CrossSpectrum", "the spectrum of the signal");
    StoredSpectrum s;
    s.of = of;
    s.with = named(info, "unsigned_int", "m_uSignodeId").text().as_uint();
    s.averages = named(info, "unsigned_int", "m_uNumSpectraInAvg").text().as_uint();
    const auto pairs = array(data, "m_ValueVector", 2);
    for (std::size_t k = 0; k < pairs.size(); k += 2) s.values.emplace_back(pairs[k], pairs[k + 1]);
    s.frequency = array(data, "m_FrequencyVector", 1);
    if (s.frequency.size() != s.values.size())
      fail(data, fmt::format("{} values at {} frequencies", s.values.size(), s.frequency.size()), "as many");
    return s;
  }

  void read_signal(const pugi::xml_node& node) {
    MeasuredTestSignal signal;
    signal.node = named(node, "unsigned_int", "m_uNodeId").text().as_uint();
    signal.instance = named(node, "integer", "m_iUniqueInstanceId").text().as_int();
    for (const auto series : named(node, "LinkedList", "m_TimeSeriesList").children("TimeSeries")) {
      auto values = array(series, "m_ValueVector", 1);
      const double length = number(series, "m_TimeVector.end") - number(series, "m_TimeVector.start");
      if (values.size() < 2 || !(length > 0.0))
        fail(series, fmt::format("{} samples in {} s", values.size(), length), "a record");
      signal.period = length / static_cast<double>(values.size() - 1);
      signal.records.push_back(std::move(values));
    }
    if (const auto info = named(node, "SigNodeCrossSpectrumInfo", "m_autospectrumInfo");
        info && info.child("CrossSpectrum"))
      signal.power = spectrum(info, signal.node);
    for (const auto info : named(node, "LinkedList", "m_crossSpecInfoList").children("SigNodeCrossSpectrumInfo"))
      signal.cross.push_back(spectrum(info, signal.node));
    test_.signals.push_back(std::move(signal));
  }

  void read_excitation(const pugi::xml_node& source) {
    test_.prbs_order = named(source, "unsigned_int", "m_uPrbsOrder").text().as_uint();
    test_.rotary = named(source, "boolean", "m_bIsRotaryAxis").text().as_bool();
    test_.linear_motor = named(source, "boolean", "m_bIsLinearMotor").text().as_bool();
    test_.motor_to_axis = number(source, "m_dMotorToAxisRatio");
    test_.force_constant = number(source, "m_dMotorForceConstant");
    const auto conditions =
        named(source, "LinkedList", "m_listpExcitationSourceConditions").child("ExcitationSourceCondition");
    test_.offset = number(conditions, "m_dOffsetAmplitude");
    test_.amplitude = number(conditions, "m_dExcitationAmplitude");
  }

  void read_roles(const pugi::xml_node& root) {
    const auto roles =
        named(root, "LinkedList", "m_listPrimaryFreqRespSigNodeData").child("PrimaryFreqRespSigNodeData");
    if (!roles) fail(root, "no PrimaryFreqRespSigNodeData", "which signals are input and output");
    test_.input = index_of(roles, "m_iInputSigNodeUniqueInstanceID");
    test_.output = index_of(roles, "m_iOutputSigNodeUniqueInstanceID");
  }

  std::size_t index_of(const pugi::xml_node& roles, const char* name) const {
    const auto wanted = named(roles, "integer", name);
    for (std::size_t k = 0; k < test_.signals.size(); ++k)
      if (wanted && test_.signals[k].instance == wanted.text().as_int(-1)) return k;
    fail(roles, fmt::format("{} = '{}', which no signal has", name, excerpt(wanted.text().get())),
         "the instance of a measured signal");
  }

  std::string_view text_;
  pugi::xml_document document_;
  ResponseTest test_;
};

// (2/N)^2 of the plain transform: as the control scales its spectra.
std::vector<std::complex<double>> transform(const std::vector<double>& record) {
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> lines;
  fft.fwd(lines, record);
  lines.resize(record.size() / 2 + 1);
  for (auto& line : lines) line *= 2.0 / static_cast<double>(record.size());
  return lines;
}

// 0 where nothing answers.
double coherence_of(std::complex<double> cross, double power, double answer) {
  return power * answer > 0.0 ? std::norm(cross) / (power * answer) : 0.0;
}

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

}  // namespace

std::vector<double> base85_doubles(std::string_view text) {
  std::vector<double> values;
  std::uint64_t word = 0, pair = 0;
  int digits = 0, words = 0;
  const auto take = [&] {
    pair = (pair << 32) | word;
    word = 0;
    digits = 0;
    if (++words < 2) return;
    values.push_back(std::bit_cast<double>(pair));
    pair = 0;
    words = 0;
  };
  for (const char c : text) {
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    if (c == '.' && digits == 0) {
      take();
      continue;
    }
    const int digit = digit_values[static_cast<unsigned char>(c)];
    if (digit < 0) throw std::invalid_argument(fmt::format("the character '{}'", excerpt({&c, 1})));
    word = word * 85 + static_cast<std::uint64_t>(digit);
    if (++digits < 5) continue;
    if (word > 0xFFFFFFFF) throw std::invalid_argument("five digits beyond 32 bits");
    take();
  }
  if (digits != 0 || words != 0) throw std::invalid_argument("an array that ends within a number");
  return values;
}

bool is_response_test(std::string_view begin) {
  for (auto at = begin.find('<'); at != std::string_view::npos; at = begin.find('<', at + 1))
    if (at + 1 < begin.size() && begin[at + 1] != '?' && begin[at + 1] != '!')
      return begin.substr(at + 1).starts_with("ResponseTest");
  return false;
}

ResponseTest parse_response_test(std::string_view text, const std::string& name) { return Reader(text, name).read(); }

std::vector<TestResponsePoint> stored_response(const ResponseTest& test) {
  const auto& input = test.signals.at(test.input);
  const auto& output = test.signals.at(test.output);
  const auto found = std::ranges::find_if(output.cross, [&](const auto& c) { return c.with == input.node; });
  if (found == output.cross.end() || found->values.size() != input.power.values.size() ||
      found->values.size() != output.power.values.size())
    throw ResponseTestError(
        fmt::format("{}: found no spectra of input and output with the same lines; expected those "
                    "that the control computes (m_bSaveFrequencySpectrumDataToXML)",
                    test.source));
  std::vector<TestResponsePoint> points;
  for (std::size_t k = 0; k < found->values.size(); ++k) {
    const double power = input.power.values[k].real(), answer = output.power.values[k].real();
    if (!(power > 0.0)) continue;
    points.push_back(
        {found->frequency[k], std::conj(found->values[k]) / power, coherence_of(found->values[k], power, answer)});
  }
  return points;
}

std::vector<TestResponsePoint> computed_response(const ResponseTest& test) {
  const auto& input = test.signals.at(test.input);
  const auto& output = test.signals.at(test.output);
  const auto records = input.records.size();
  bool usable = records >= 2 && output.records.size() == records;
  for (std::size_t r = 0; usable && r < records; ++r)
    usable = input.records[r].size() == input.records[0].size() && output.records[r].size() == input.records[0].size();
  if (!usable)
    throw ResponseTestError(
        fmt::format("{}: found {} records of the input and {} of the output; expected at least two of both with the "
                    "same number of samples (m_bSaveTimeSeriesDataToXML)",
                    test.source, records, output.records.size()));
  const auto samples = input.records[0].size();
  std::vector<std::complex<double>> cross(samples / 2 + 1);
  std::vector<double> power(cross.size()), answer(cross.size());
  for (std::size_t r = 0; r < records; ++r) {
    const auto in = transform(input.records[r]), out = transform(output.records[r]);
    for (std::size_t k = 0; k < cross.size(); ++k) {
      cross[k] += out[k] * std::conj(in[k]);
      power[k] += std::norm(in[k]);
      answer[k] += std::norm(out[k]);
    }
  }
  std::vector<TestResponsePoint> points;
  for (std::size_t k = 0; k < cross.size(); ++k) {
    if (!(power[k] > 0.0)) continue;
    const double frequency = static_cast<double>(k) / (static_cast<double>(samples) * input.period);
    points.push_back({frequency, cross[k] / power[k], coherence_of(cross[k], power[k], answer[k])});
  }
  return points;
}

ResponseDifference compare_responses(const std::vector<TestResponsePoint>& ours,
                                     const std::vector<TestResponsePoint>& stored, double least) {
  // The control leaves out the highest line of an odd number of samples.
  if (stored.empty() || ours.size() < stored.size() || ours.size() > stored.size() + 1)
    throw ResponseTestError(
        fmt::format("found {} lines computed and {} stored; expected as many", ours.size(), stored.size()));
  ResponseDifference difference;
  for (std::size_t k = 0; k < stored.size(); ++k) {
    if (!(ours[k].coherence > least) || !(stored[k].coherence > least)) continue;
    const auto ratio = ours[k].gain / stored[k].gain;
    ++difference.lines;
    difference.gain_db = std::max(difference.gain_db, std::abs(20.0 * std::log10(std::abs(ratio))));
    difference.phase_deg = std::max(difference.phase_deg, std::abs(degrees(std::arg(ratio))));
  }
  return difference;
}

}  // namespace stiction::host
