// An axis behind a cam hides an effect that the record of its first cam does not tell from another one. The cam that
// the diagnosis proposes is then run on that axis as `simulate cam` runs it, and both records are diagnosed.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace stiction::cam_ambiguity {

struct Kind {
  const char* name;
  const char* hidden;
  const char* rival;
};
std::span<const Kind> kinds();

struct Outcome {
  bool ambiguous = false;  // whether the first records named one of the two and left it open
  bool proposed = false;   // a cam, for this question
  bool settled = false;    // by both records: the hidden one is named alone
  double expected = 0.0;   // standard errors of the proposed cam
  double before = 0.0;     // of the first records
  std::string text;        // what was hidden, found, proposed, found then
};

// Of a case of `kind`, drawn with `seed`: size of the effect, law, rise, stroke and speeds of the first cam.
Outcome run(const Kind& kind, std::uint64_t seed);

}  // namespace stiction::cam_ambiguity
