// What all who work on one sweep agree on: it is in the folder of the results before the first chunk is run, and
// whoever joins later, or resumes, must find the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/sweep/commands.hpp"
#include "host/sweep/spec.hpp"

namespace stiction::host {

struct SweepPlan {
  std::string version;  // of the programme, with a digest of its file: no two builds share a sweep
  std::string input;    // digest of the specification and of the files that it names
  std::uint64_t rows = 0;
  std::uint64_t chunk = 1;           // rows of a chunk
  std::vector<SweepFigure> figures;  // names and units; their values are of no row

  std::string text() const;  // JSON
};

// What `text` says; none where it is no plan.
std::optional<SweepPlan> parse_plan(const std::string& text);

// Throws machine::MachineFileError "FOLDER: found ...; expected ..." unless `found`, of `folder`, is of the same build
// and the same input as `own`.
void require_same(const SweepPlan& found, const SweepPlan& own, const std::filesystem::path& folder);

// `version` of the programme with a digest of the file that runs.
std::string build_identity(const std::string& version);

// A digest of the text of `spec` and of the machine files and logs that it names. Throws machine::MachineFileError,
// machine::UnreadableFile.
std::string input_identity(const SweepSpec& spec);

// Rows of a chunk of a sweep of `rows`: a thousandth of them, so that there are enough to share out and few enough to
// list, but at most 10000.
std::uint64_t chunk_length(std::uint64_t rows);

}  // namespace stiction::host
