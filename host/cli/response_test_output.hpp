// `stiction simulate frequency-response --from FILE.XML`: the response test of a control, as text and as JSON.
#pragma once

#include <string>

namespace stiction::host {

// Whether `file` is a response test; false also where it cannot be read, as a log says what is wrong with it.
bool is_response_test_file(const std::string& file);

// Prints the response that follows from the file's time series, and how far that which the control stored is from it.
// `file`: XML of a SINUMERIK's response test, plain or compressed by gzip; `json`: as "stiction.response-test/1".
// Throws UsageError for a file that is none.
void print_response_test(const std::string& file, bool json);

}  // namespace stiction::host
