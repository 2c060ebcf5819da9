#!/usr/bin/env python3
"""Plants violations in a temporary tree and expects check_rooms.py to find each of them, and nothing else."""

import pathlib
import tempfile
import unittest

import check_rooms

NUMBER = "firmware/include/stiction/number/fixed.hpp"
CONTROL = "firmware/include/stiction/control/pi.hpp"

SOUND = {
    NUMBER: "#include <cstdint>\n",
    CONTROL: '#include <array>\n\n#include "stiction/number/fixed.hpp"\n',
    "hal/backend.hpp": '#include <vector>\n#include "stiction/control/pi.hpp"\n',
    "hal/simulated/simulated_backend.hpp": '#include "hal/backend.hpp"\n#include "sim/plant/axis_plant.hpp"\n',
    "hal/can/can_backend.hpp": '#include "hal/backend.hpp"\n',
    "sim/plant/axis_plant.hpp": '#include "firmware/machine/model/machine.hpp"\n',
    "firmware/machine/model/machine.hpp": "#include <string>\n",
    "sim/effects/drag/drag.hpp": '#include "firmware/machine/model/machine.hpp"\n',
    "sim/effects/drag/regressor.cpp": '#include "host/diagnose/classes/candidate.hpp"\n#include "sim/effects/drag/drag.hpp"\n',
    "host/diagnose/classes/candidate.hpp": '#include "firmware/machine/model/machine.hpp"\n',
    "host/report/page.hpp": '#include "firmware/machine/model/machine.hpp"\n',
    "host/identify/fit.hpp": '#include "firmware/machine/model/machine.hpp"\n',
    "host/cli/main.cpp": '#include "host/report/page.hpp"\n#include "host/identify/fit.hpp"\n',
    "tests/hal/CMakeLists.txt": "stiction_test(hal_test backend_test.cpp new_test.cpp)\n",
    "tests/hal/backend_test.cpp": '#include "hal/simulated/simulated_backend.hpp"\n',
}


def findings_in(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return check_rooms.check(root)[0]


class CheckRooms(unittest.TestCase):
    def expect_finding(self, file, line, *words):
        findings = findings_in(SOUND | {file: SOUND.get(file, "") + line + "\n"})
        self.assertEqual(len(findings), 1, findings)
        place = f"{file}:{SOUND.get(file, '').count(chr(10)) + 1}"
        for word in (place, *words):
            self.assertIn(word, findings[0])

    def test_accepts_arrows_that_run_down(self):
        self.assertEqual(findings_in(SOUND), [])

    def test_accepts_tests_of_a_recipe_and_no_product_with_it(self):
        page = {"docs/extending.md": "`hal/new/new.hpp`:\n\n```cpp\n```\n"}
        include = '#include "hal/new/new.hpp"\n'
        self.assertEqual(findings_in(SOUND | page | {"tests/hal/new_test.cpp": include}), [])
        self.assertEqual(len(findings_in(SOUND | page | {"hal/can/can_backend.hpp": include})), 1)

    def test_finds_a_hosted_header_in_the_firmware(self):
        self.expect_finding(NUMBER, "#include <vector>", "<vector>", "freestanding")

    def test_finds_floating_point_mathematics_in_the_firmware(self):
        self.expect_finding(CONTROL, "  #  include <cmath>", "<cmath>")

    def test_finds_the_firmware_including_the_simulation(self):
        self.expect_finding(CONTROL, '#include "firmware/machine/model/machine.hpp"', "may not include firmware/machine/model")

    def test_finds_numbers_that_know_the_laws(self):
        findings = findings_in(SOUND | {NUMBER: '#include "stiction/control/pi.hpp"\n'})
        self.assertEqual(len(findings), 2, findings)
        self.assertIn("may not include", findings[0])
        self.assertIn("circle", findings[1])

    def test_finds_a_real_backend_that_knows_the_simulation(self):
        self.expect_finding("hal/can/can_backend.hpp", '#include "firmware/machine/model/machine.hpp"', "hal/can may not include firmware/machine/model")

    def test_finds_a_real_backend_that_knows_the_simulated_one(self):
        self.expect_finding("hal/can/can_backend.hpp", '#include "hal/simulated/simulated_backend.hpp"',
                            "hal/can may not include hal/simulated")

    def test_finds_the_simulation_including_a_tool(self):
        findings = findings_in(SOUND | {"firmware/machine/model/machine.hpp": '#include "host/report/page.hpp"\n'})
        self.assertIn("firmware/machine/model may not include host/report", findings[0])

    def test_tells_a_folder_from_what_lies_below_it(self):
        shared = {"sim/files.hpp": "#include <limits>\n", "sim/plant/plant.hpp": ""}
        self.assertEqual(findings_in(SOUND | shared | {"sim/vocabulary/a.cpp": '#include "sim/files.hpp"\n'}), [])
        findings = findings_in(SOUND | shared | {"sim/vocabulary/a.cpp": '#include "sim/plant/plant.hpp"\n'})
        self.assertIn("sim/vocabulary may not include sim/plant", findings[0])

    def test_lets_a_regressor_know_the_diagnosis_but_not_the_law_beside_it(self):
        self.expect_finding("sim/effects/drag/drag.hpp", '#include "host/identify/fit.hpp"',
                            "sim/effects may not include host/identify")
        self.expect_finding("sim/effects/drag/regressor.cpp", '#include "host/report/page.hpp"',
                            "regressor.cpp may not include host/report")

    def test_finds_a_report_that_knows_the_command_line(self):
        findings = findings_in(SOUND | {"host/report/page.hpp": '#include "host/cli/main.cpp"\n'})
        self.assertIn("host/report may not include host/cli", findings[0])

    def test_lets_a_report_show_what_a_tool_found_but_not_the_tool_know_its_report(self):
        self.assertEqual(findings_in(SOUND | {"host/report/page.hpp": '#include "host/identify/fit.hpp"\n'}), [])
        self.expect_finding("host/identify/fit.hpp", '#include "host/report/page.hpp"',
                            "host/identify may not include host/report")

    def test_finds_what_includes_a_test(self):
        self.expect_finding("host/cli/main.cpp", '#include "tests/hal/backend_test.cpp"', "may not include tests/hal")

    def test_finds_folders_that_include_each_other(self):
        findings = findings_in(SOUND | {"tests/a/a.hpp": '#include "tests/b/b.hpp"\n',
                                        "tests/b/b.hpp": '#include "tests/c/c.hpp"\n',
                                        "tests/c/c.hpp": '#include "tests/a/a.hpp"\n'})
        self.assertEqual(len(findings), 1, findings)
        self.assertIn("tests/a -> tests/b -> tests/c -> tests/a", findings[0])

    def test_finds_a_folder_that_is_no_room(self):
        findings = findings_in(SOUND | {"host/guess/guess.hpp": "#include <string>\n"})
        self.assertEqual(findings, ["host/guess/guess.hpp: host/guess is not a room; add it to ROOMS with the reasons "
                                    "for its arrows"])

    def test_finds_an_include_that_hides_its_target(self):
        self.expect_finding("host/cli/main.cpp", "#include HEADER", "HEADER")

    def test_finds_a_path_that_does_not_start_at_the_root(self):
        self.expect_finding("host/report/page.hpp", '#include "machine.hpp"', 'no "machine.hpp"')

    def test_finds_a_test_that_nothing_builds(self):
        self.assertEqual(findings_in(SOUND | {"tests/hal/can_test.cpp": "#include <string>\n"}),
                         ["tests/hal/can_test.cpp: no CMakeLists.txt names this test; expected one that builds it"])
        by_pattern = {"tests/sim/CMakeLists.txt": "file(GLOB plant CONFIGURE_DEPENDS plant/*_test.cpp)\n",
                      "tests/sim/plant/axis_test.cpp": "#include <string>\n"}
        self.assertEqual(findings_in(SOUND | by_pattern), [])


if __name__ == "__main__":
    unittest.main()
