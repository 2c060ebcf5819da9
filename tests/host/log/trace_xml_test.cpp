// Servo traces of SINUMERIK Operate as XML.
#include <gtest/gtest.h>

#include "host/log/mapping.hpp"
#include "host/log/read_log.hpp"
#include "host/log/text_file.hpp"
#include "tests/host/log/temporary_file.hpp"

namespace stiction::host {
namespace {

// Signals are described in one order and recorded in another.
const std::string trace = R"(<?xml version="1.0" encoding="UTF-8"?>
<traceCaptureSession>
 <traceDisplaySetup><signals>
  <signal key="a" name="/Nck/Axis/Current[u1, 3]" description="current"/>
  <signal key="b" name="/Nck/Axis/Position[u1, 3]" description="position"/>
 </signals></traceDisplaySetup>
 <traceData><dataFrame>
  <frameHeader><dataSignal key="b"/><dataSignal key="a"/></frameHeader>
  <rec time="0.000" f1="10.5" f2="1"/>
  <rec time="0.004" f1="10.75" f2="-2"/>
  <rec time="0.008" f1="11" f2="3"/>
 </dataFrame></traceData>
</traceCaptureSession>
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string refusal(const std::string& text) {
  const test::TemporaryFile file(".xml");
  write_text_file(file.path(), text);
  try {
    read_log(file.path());
  } catch (const LogError& error) {
    return error.what();
  }
  return "";
}

TEST(TraceXml, NamesItsSignalsByTheirKeys) {
  const auto recording = read_trace_xml(trace, "trace.xml");
  ASSERT_EQ(recording.channels.size(), 2u);
  EXPECT_EQ(recording.channels[0].name, "/Nck/Axis/Position[u1, 3]");
  EXPECT_EQ(recording.channels[0].values, (std::vector<double>{10.5, 10.75, 11.0}));
  EXPECT_EQ(recording.channels[1].values, (std::vector<double>{1.0, -2.0, 3.0}));
  EXPECT_EQ(recording.channels[1].t, (std::vector<double>{0.0, 0.004, 0.008}));
  EXPECT_EQ(recording.channels[1].lines, (std::vector<std::size_t>{9, 10, 11}));
}

TEST(TraceXml, IsRefusedWithTheLineOrTheMappingThatItNeeds) {
  EXPECT_NE(refusal(trace).find("found a servo trace of a SINUMERIK with the channels '/Nck/Axis/Position[u1, 3]'"),
            std::string::npos)
      << refusal(trace);
  EXPECT_NE(refusal(replaced(trace, "0.004", "soon")).find(".xml:10: found the time 'soon'; expected"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(trace, "</dataFrame>", "")).find(":12: found no valid XML"), std::string::npos)
      << refusal(replaced(trace, "</dataFrame>", ""));
  EXPECT_NE(refusal("<html></html>").find("found the element <html>"), std::string::npos);
  EXPECT_NE(refusal("<ResponseTestCustom/>").find("frequency-response --from"), std::string::npos);
}

}  // namespace
}  // namespace stiction::host
