// What a drive's recorder left behind, before a mapping (mapping.hpp) says what its channels are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/log/log.hpp"
#include "host/log/sampling.hpp"

namespace stiction::host {

// Scale factors and offsets in the head of a scope export, of which the file does not say whether its values have them
// already: the setting "Scale values" decides that, and is not written.
struct HeadScaling {
  double factor = 1.0, offset = 0.0, unit_factor = 1.0, unit_offset = 0.0;
  bool known = true;  // false: the head cannot be read here
  double operator()(double raw) const { return (raw * factor + offset) * unit_factor + unit_offset; }
  bool operator==(const HeadScaling&) const = default;
};

struct RecordedChannel {
  std::string name;
  std::string unit;                         // as the file states it; empty: it does not
  std::vector<double> t;                    // s; a channel may have fewer samples than others
  std::vector<double> values;               // in `unit`
  std::vector<std::size_t> lines;           // of the samples; empty where the format has none
  std::string bad;                          // why it cannot be used, "FILE:LINE: found ..."; empty: it can
  std::optional<HeadScaling> scaling = {};  // none: there is none, or it changes nothing
};

struct Recording {
  std::string source;  // the file
  std::string kind;    // "a TwinCAT Scope export"
  std::vector<std::pair<std::string, std::string>> comments;
  std::vector<RecordedChannel> channels;
  StampDigits digits;
};

// "FILE:LINE" of a sample, or "FILE: sample N" where the format has no lines. `recording`: whose file is named;
// `channel`: of the sample; `sample`: its index.
std::string place_of(const Recording& recording, const RecordedChannel& channel, std::size_t sample);

// A decimal number with a point, or with a comma where `decimal` is ','; a plus sign and blanks around it are allowed.
// False for anything else, infinite numbers and NaN. `text`: the whole number; `value`: is written where it is one.
bool parse_number(std::string_view text, char decimal, double& value);

// How a table of numbers is written that says nothing of it itself.
struct TableForm {
  char separator = 0;           // 0: found in the header
  char decimal = 0;             // 0: a comma, where the separator is none and the numbers have some
  std::size_t header_line = 0;  // with the names; 0: the first line that is neither empty nor a "#" comment
  std::string time_column;      // empty: `period` counts
  std::string time_unit;        // of that column
  double period = 0.0;          // s, without a time column
};

// Text of the TwinCAT Scope (Beckhoff TE13xx, "Export to CSV"), also compressed by gzip: head, one block of rows that
// begin with their key (Name, SymbolName, Data-Type, SampleTime[ms], Unit, ...), data. The separator is a tab, a blank,
// a colon, a semicolon or a comma, as the first line shows. A key repeated within its row begins a group with a time
// column of its own: one a channel, one a sample time or one for all. Time is in ms from the start, or FILETIME (100 ns
// from 1601). Decimal comma or point; cells are empty or blank, or rows end early, where a channel has no sample;
// repeated stamps fill slower channels; a last row "EOF" may follow. Scale factors and offsets of the head are kept
// beside the values: the mapping says whether they are applied. `text`: of the file or its begin; `name`: for messages.
bool is_scope_export(std::string_view text);
Recording read_scope_export(std::string_view text, const std::string& name);

// Recording of a SINUMERIK Edge (Capture4Analysis), JSON or JSON in a zip archive: Header.SignalListHFData names the
// columns (their order differs from job to job), Header.CycleTimeMs their period, the rows are Payload[].HFData, and
// CYCLE (HFProbeCounter) counts the cycles. Channels are named by Address ("ENC_POS|1"). Written after public
// descriptions of the format, not tried on a machine's file of ours.
bool is_recorder_export(std::string_view bytes);
Recording read_recorder_export(const std::string& bytes, const std::string& name);

// Servo trace that SINUMERIK Operate saves as XML: traceDisplaySetup/signals describe the signals by key, and
// traceData/dataFrame holds <rec time="s" f1=".." f2=".."/>. Written after public descriptions of the format, not tried
// on a machine's file of ours. `begin`: the first bytes; `text`: of the file; `name`: for messages. Throws LogError.
bool is_trace_xml(std::string_view begin);
Recording read_trace_xml(std::string_view text, const std::string& name);

// Any table with one header line, separated by tabs, semicolons or commas. `text`: of the file; `name`: for messages;
// `form`: separator, decimal mark, header line and time. Throws LogError.
Recording read_plain_table(std::string_view text, const std::string& name, const TableForm& form);

// Vectors and columns of matrices ("M(:,2)") of a MAT-file, with the time that `form` names; no mark of lines. `file`:
// of level 5 or 7.3. Throws LogError.
Recording read_mat_recording(const std::filesystem::path& file, const TableForm& form);

// The one of these that the content is, also compressed by gzip. Throws LogError.
Recording read_recording(const std::filesystem::path& file, const TableForm& form);

}  // namespace stiction::host
