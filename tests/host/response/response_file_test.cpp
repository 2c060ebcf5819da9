// Response tests of SINUMERIK Operate. The real one lies outside of the repository (shared/data/sinumerik); the one
// made here has its shape and spectra that are summed up term by term.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>

#include "host/log/text_source.hpp"
#include "host/response/response_test.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;

// As the control writes doubles.
std::string base85(const Values& values) {
  constexpr std::string_view digits =
      "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ!#$`()*+-/:;=?@[]^_{|}~";
  std::string text;
  for (const double value : values) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (const auto word : {static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits)}) {
      if (word == 0) {
        text += '.';
        continue;
      }
      std::string five;
      for (std::uint32_t rest = word, k = 0; k < 5; ++k, rest /= 85) five.insert(five.begin(), digits[rest % 85]);
      text += five + "\n ";
    }
  }
  return text;
}

std::string array(const char* name, const Values& values, std::size_t doubles_each) {
  return fmt::format(
      "<NumericArray format=\"base85\" name=\"{}\"><unsigned_int name=\"m_length\">{}</unsigned_int>"
      "<raw name=\"m_pNumberArray\"><![CDATA[\n{}]]></raw></NumericArray>\n",
      name, values.size() / doubles_each, base85(values));
}

std::string series(const Values& values, double period) {
  return fmt::format(
      "<TimeSeries>{}<float name=\"m_TimeVector.start\">0</float><float name=\"m_TimeVector.end\">{}</float>"
      "</TimeSeries>\n",
      array("m_ValueVector", values, 1), period * static_cast<double>(values.size() - 1));
}

std::string spectrum(const char* name, unsigned with, const Values& pairs, const Values& frequency) {
  return fmt::format(
      "<SigNodeCrossSpectrumInfo name=\"{}\"><unsigned_int name=\"m_uSignodeId\">{}</unsigned_int>"
      "<unsigned_int name=\"m_uNumSpectraInAvg\">2</unsigned_int><CrossSpectrum>{}{}</CrossSpectrum>"
      "</SigNodeCrossSpectrumInfo>\n",
      name, with, array("m_ValueVector", pairs, 2), array("m_FrequencyVector", frequency, 1));
}

constexpr double period = 1e-3;
const std::vector<Values> input{{1.0, -0.5, 0.25, 2.0, -1.0}, {0.5, 1.5, -2.0, 0.25, 1.0}};
// Half the input a sample later, around the ring.
const std::vector<Values> output{{-0.5, 0.5, -0.25, 0.125, 1.0}, {0.5, 0.25, 0.75, -1.0, 0.125}};

// The mean of (2/N)^2 conj(A_k) B_k, term by term.
Values cross(const std::vector<Values>& a, const std::vector<Values>& b) {
  Values pairs;
  const std::size_t n = a[0].size();
  for (std::size_t k = 0; k <= n / 2; ++k) {
    std::complex<double> sum;
    for (std::size_t r = 0; r < a.size(); ++r)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
          const double angle = 2.0 * std::numbers::pi * static_cast<double>(k * i) / static_cast<double>(n) -
                               2.0 * std::numbers::pi * static_cast<double>(k * j) / static_cast<double>(n);
          sum += a[r][i] * b[r][j] * std::polar(1.0, angle);
        }
    sum *= 4.0 / static_cast<double>(n * n * a.size());
    pairs.push_back(sum.real());
    pairs.push_back(sum.imag());
  }
  return pairs;
}

std::string made() {
  const Values frequency{0.0, 200.0, 400.0};
  const auto node = [&](unsigned id, int instance, const std::vector<Values>& records, const std::string& spectra) {
    return fmt::format(
        "<PlatformSignalNode><unsigned_int name=\"m_uNodeId\">{}</unsigned_int><integer "
        "name=\"m_iUniqueInstanceId\">{}</integer><LinkedList name=\"m_TimeSeriesList\">{}{}</LinkedList>{}"
        "</PlatformSignalNode>\n",
        id, instance, series(records[0], period), series(records[1], period), spectra);
  };
  return "<?xml version=\"1.0\"?>\n<!-- 4.7 -->\n<ResponseTestCustom ver=\"4.7\">\n"
         "<unsigned_int name=\"m_uAxis\">3</unsigned_int>\n<LinkedList name=\"m_MeasurementSignalNodeList\">\n" +
         node(61, 0, output,
              spectrum("m_autospectrumInfo", 61, cross(output, output), frequency) +
                  "<LinkedList name=\"m_crossSpecInfoList\">" +
                  spectrum("m_crossSpecInfoList_el", 62, cross(output, input), frequency) + "</LinkedList>") +
         node(62, 1, input, spectrum("m_autospectrumInfo", 62, cross(input, input), frequency)) +
         "</LinkedList>\n<LinkedList name=\"m_listPrimaryFreqRespSigNodeData\"><PrimaryFreqRespSigNodeData>"
         "<integer name=\"m_iInputSigNodeUniqueInstanceID\">1</integer>"
         "<integer name=\"m_iOutputSigNodeUniqueInstanceID\">0</integer></PrimaryFreqRespSigNodeData></LinkedList>\n"
         "</ResponseTestCustom>\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  return text.replace(text.find(from), from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    const auto test = parse_response_test(text, "test.xml");
    compare_responses(computed_response(test), stored_response(test), 0.9);
  } catch (const ResponseTestError& error) {
    return error.what();
  }
  return "";
}

TEST(Base85, GivesBackEveryDouble) {
  const Values values{0.0, 1.0, -2.5, 1e-300, std::nextafter(0.1, 1.0), 5e-324, -1.7976931348623157e308, 2147483648.0};
  EXPECT_EQ(base85_doubles(base85(values)), values);
  EXPECT_TRUE(base85_doubles("").empty());
  for (const auto* bad : {"0000", "kG!pG", "~~~~~.", "kG!p\"I$!YV", "kG.pGI$!YV"})
    EXPECT_THROW(base85_doubles(bad), std::invalid_argument) << bad;
}

TEST(ResponseTest, FollowsFromTheRecordsAsFromTheStoredSpectra) {
  ASSERT_TRUE(is_response_test(made()));
  const auto test = parse_response_test(made(), "test.xml");
  EXPECT_EQ(test.axis, 3u);
  EXPECT_EQ(test.signals.at(test.input).records, input);
  EXPECT_EQ(test.signals.at(test.output).records, output);
  EXPECT_DOUBLE_EQ(test.signals.at(0).period, period);
  const auto ours = computed_response(test), stored = stored_response(test);
  ASSERT_EQ(ours.size(), 3u);
  for (std::size_t k = 0; k < ours.size(); ++k) {
    EXPECT_DOUBLE_EQ(ours[k].frequency, 200.0 * static_cast<double>(k));
    // Half, and later by one sample of five: the phase falls.
    const auto truth = std::polar(0.5, -2.0 * std::numbers::pi * static_cast<double>(k) / 5.0);
    EXPECT_NEAR(std::abs(ours[k].gain - truth), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(stored[k].gain - truth), 0.0, 1e-12);
    EXPECT_NEAR(ours[k].coherence, 1.0, 1e-12);
  }
  const auto difference = compare_responses(ours, stored, 0.9);
  EXPECT_EQ(difference.lines, 3u);
  EXPECT_LT(difference.gain_db, 1e-9);
}

TEST(ResponseTest, IsRefusedWithTheLineAndWhatItLacks) {
  const auto expect = [](const std::string& text, const std::string& message) {
    EXPECT_NE(refusal(text).find(message), std::string::npos) << refusal(text) << "\n" << message;
    EXPECT_NE(refusal(text).find("expected "), std::string::npos);
  };
  expect(made().substr(0, 900), "found no valid XML");
  expect("<a/>", "test.xml:1: found the element <a>");
  expect(replaced(made(), "\"base85\"", "\"hex\""), "test.xml:6: found an array in the format 'hex'");
  expect(replaced(made(), "<![CDATA[\n", "<![CDATA[\n\""), "found the character '\"'");
  expect(replaced(made(), "m_length\">5", "m_length\">6"), "found 5 numbers in m_ValueVector; expected 6");
  expect(replaced(made(), "InstanceID\">1<", "InstanceID\">7<"), "InstanceID = '7', which no signal has");
  expect(replaced(made(), "<unsigned_int name=\"m_uSignodeId\">62", "<unsigned_int name=\"m_uSignodeId\">63"),
         "found no spectra of input and output");
  expect(replaced(made(), "m_listPrimaryFreqRespSigNodeData", "m_list"), "found no PrimaryFreqRespSigNodeData");
  EXPECT_EQ(refusal(made()), "");
}

TEST(ResponseTest, RealSpectraFollowFromTheirOwnTimeSeries) {
  const auto file =
      std::filesystem::path(STICTION_SOURCE_DIR) / ".." / "shared" / "data" / "sinumerik" / "freq_trace.XML";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const auto test = parse_response_test(read_plain_or_gzip(file), "freq_trace.XML");
  ASSERT_EQ(test.signals.size(), 2u);
  const auto& in = test.signals[test.input];
  const auto& out = test.signals[test.output];
  EXPECT_EQ(in.node, 62u);
  EXPECT_EQ(out.node, 61u);
  EXPECT_DOUBLE_EQ(in.period, 125e-6);
  EXPECT_EQ(test.sampling, 0.000125);
  EXPECT_DOUBLE_EQ(test.motor_to_axis, 200.0 * std::numbers::pi);
  // The excitation is a sequence of two values, offset more and less amplitude, as finely as the drive counts its set
  // speed (1e-5 of the amplitude in this record).
  ASSERT_EQ(in.records.size(), 2u);
  for (std::size_t r = 0; r < 2; ++r) {
    ASSERT_EQ(in.records[r].size(), 2047u);
    for (const double value : in.records[r])
      ASSERT_NEAR(std::abs(std::abs(value) - test.offset), test.amplitude, 2e-5 * test.amplitude);
  }
  // The stored spectra follow from the records to the rounding of another transform: any digit decoded wrongly in one
  // of them would be seen.
  const auto transformed = [](const std::vector<double>& x, std::size_t k) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += x[i] * std::polar(2.0 / static_cast<double>(x.size()), -2.0 * std::numbers::pi *
                                                                        static_cast<double>((k * i) % x.size()) /
                                                                        static_cast<double>(x.size()));
    return sum;
  };
  const auto& stored = out.cross.at(0).values;
  ASSERT_EQ(stored.size(), 1023u);
  for (std::size_t k = 0; k < stored.size(); ++k) {
    std::complex<double> cross_sum;
    double in_power = 0.0, out_power = 0.0;
    for (std::size_t r = 0; r < 2; ++r) {
      const auto u = transformed(in.records[r], k), y = transformed(out.records[r], k);
      cross_sum += 0.5 * std::conj(y) * u;
      in_power += 0.5 * std::norm(u);
      out_power += 0.5 * std::norm(y);
    }
    const double size = std::sqrt(in_power * out_power);
    ASSERT_NEAR(std::abs(stored[k] - cross_sum), 0.0, 1e-10 * size) << k;
    ASSERT_NEAR(in.power.values[k].real(), in_power, 1e-10 * in_power) << k;
    ASSERT_NEAR(out.power.values[k].real(), out_power, 1e-10 * out_power) << k;
  }
  const auto difference = compare_responses(computed_response(test), stored_response(test), 0.9);
  EXPECT_EQ(difference.lines, 473u);
  EXPECT_LT(difference.gain_db, 1e-9);    // wanted: 1 dB
  EXPECT_LT(difference.phase_deg, 1e-9);  // wanted: 5 degrees
}

}  // namespace
}  // namespace stiction::host
