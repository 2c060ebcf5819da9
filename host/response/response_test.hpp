// Response tests that SINUMERIK Operate saves as XML (ResponseTestCustom): excitation, measured time series, the
// spectra that the control computed of them, and data of the axis.
//
// Arrays of doubles are kept as text: big-endian IEEE doubles in two words of 32 bits, each as five digits to the base
// 85 with the digits 0-9 a-z A-Z !#$`()*+-/:;=?@[]^_{|}~, the highest first; a word of zero is one point. Found by
// looking, and after https://github.com/eliasrhoden/Trace-Tools. A cross-spectrum of the signals a and b is the mean
// over the records of (2/N)^2 conj(A_k) B_k, with the plain discrete Fourier transforms A and B of N samples: the
// stored numbers follow from the stored records to 2e-12.
#pragma once

#include <complex>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace stiction::host {

// A file that is no response test. what() is "FILE:LINE: found ...; expected ...".
class ResponseTestError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A spectrum as the file has it.
struct StoredSpectrum {
  unsigned of = 0, with = 0;                 // signal nodes; both the same: the power
  unsigned averages = 0;                     // how many spectra are in the mean
  std::vector<double> frequency;             // Hz, as written: not always a multiple of 1/(N T)
  std::vector<std::complex<double>> values;  // of conj(of) with
};

struct MeasuredTestSignal {
  unsigned node = 0;                         // number of the signal node
  int instance = 0;                          // by which the file says what is input and output
  std::vector<std::vector<double>> records;  // one for each run, in the file's unit
  double period = 0.0;                       // s
  StoredSpectrum power;
  std::vector<StoredSpectrum> cross;
};

struct ResponseTest {
  std::string source, software, date;  // date: "20221123", as written
  unsigned axis = 0;
  bool rotary = false, linear_motor = false;
  double motor_to_axis = 0.0;                              // rad of the motor for a m (rad) of the axis
  double force_constant = 0.0;                             // N m/A (N/A) of the motor
  double sampling = 0.0, bandwidth = 0.0, settling = 0.0;  // s, Hz, s
  double offset = 0.0, amplitude = 0.0;                    // of the excitation, in the file's unit
  unsigned prbs_order = 0;
  std::vector<MeasuredTestSignal> signals;
  std::size_t input = 0, output = 0;  // of the response, in `signals`
};

struct TestResponsePoint {
  double frequency = 0.0;       // Hz
  std::complex<double> gain{};  // output over input
  double coherence = 0.0;
};

// The doubles of an array's text. `text`: with any white space. Throws std::invalid_argument with what was
// found for text that is none.
std::vector<double> base85_doubles(std::string_view text);

// Whether the first bytes of a file are those of a response test: XML whose first element is named ResponseTest...
bool is_response_test(std::string_view begin);

// `text`: of the file; `name`: for messages. Throws ResponseTestError.
ResponseTest parse_response_test(std::string_view text, const std::string& name);

// The response that the control computed and stored, at the frequencies that it wrote. `test`: with spectra. Throws
// ResponseTestError where the file has none of output with input.
std::vector<TestResponsePoint> stored_response(const ResponseTest& test);

// The same from the time series: the cross-spectrum with the input over the power of the input, averaged over the
// records, line by line. `test`: with records. Throws ResponseTestError where there are fewer than two of equal length,
// without which the coherence would be 1 whatever they are.
std::vector<TestResponsePoint> computed_response(const ResponseTest& test);

// Where ours and the stored response are compared: lines of the same number, as the file's frequencies are its labels.
struct ResponseDifference {
  std::size_t lines = 0;  // with a coherence above `least`
  double gain_db = 0.0;   // the largest difference of them
  double phase_deg = 0.0;
};

// `ours`, `stored`: line by line; `least`: coherence of both above which a line counts. Throws ResponseTestError where
// they have different lines.
ResponseDifference compare_responses(const std::vector<TestResponsePoint>& ours,
                                     const std::vector<TestResponsePoint>& stored, double least);

}  // namespace stiction::host
