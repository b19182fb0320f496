"""What tools/lab/mutate takes away from a source, and that it leaves the rest as it is."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(sys.argv[1]) / "tools/lab"))
import mutants  # noqa: E402

SOURCE = """
void start() {
  RCC::CR::modify(RCC::CR::HSEON(1));
  Timer::CCER::write(typename Timer::CCER::CC1E(1),
                     typename Timer::CCER::CC2E(1));
  ADC1::CR2::write(armed | ADC1::CR2::SWSTART::mask);
  Control::modify(endpoint, Control::SNAK(1));
  static_cast<void>(TIM1::CR1::read());
  if (count > 3) count = 0;
  asm volatile(
      "ldr r3, =%c[off] \\n"
      "str r3, [r2] \\n");
}
"""

made = mutants.register_mutants("a.cpp", SOURCE)
assert [(mutant.line, mutant.what) for mutant in made] == [
    (3, "without RCC::CR::modify(RCC::CR::HSEON(1))"),
    (4, "without Timer::CCER::write(typename Timer::CCER::CC1E(1), typename Timer::CCER::CC2E(1))"),
    (4, "Timer::CCER::write(...) without typename Timer::CCER::CC1E(1)"),
    (4, "Timer::CCER::write(...) without typename Timer::CCER::CC2E(1)"),
    (6, "without ADC1::CR2::write(armed | ADC1::CR2::SWSTART::mask)"),
    (6, "ADC1::CR2::write(...) without armed"),
    (6, "ADC1::CR2::write(...) without ADC1::CR2::SWSTART::mask"),
    (7, "without Control::modify(endpoint, Control::SNAK(1))"),
    (7, "Control::modify(...) without Control::SNAK(1)"),
    (12, r'without "str r3, [r2] \n"'),
], made

by_name = {mutant.what: mutant.applied_to(SOURCE) for mutant in made}
assert "  static_cast<void>(0);\n  Timer" in by_name["without RCC::CR::modify(RCC::CR::HSEON(1))"]
assert "write(typename Timer::CCER::CC2E(1));" in by_name["Timer::CCER::write(...) without typename Timer::CCER::CC1E(1)"]
assert "write(armed);" in by_name["ADC1::CR2::write(...) without ADC1::CR2::SWSTART::mask"]
assert "modify(endpoint);" in by_name["Control::modify(...) without Control::SNAK(1)"]
assert '"nop \\n");' in by_name[r'without "str r3, [r2] \n"']

others = mutants.other_mutants("a.cpp", SOURCE)
assert "if (not (count > 3))" in [mutant.what for mutant in others], others
assert any("if (!(count > 3)) count = 0;" in mutant.applied_to(SOURCE) for mutant in others)
assert mutants.sample(others, 2, 1) == mutants.sample(others, 2, 1)

CODE = """
bool is_bad(int count, bool known) {
  if (count > 3 && known) count = 0;
  return count < 0 || (known && count(known, 2) == 1);
}
    {State::ready, State::ramping, events(Event::enable), events(Event::disable, Event::stop)},
    {State::ready, State::unreferenced, {}, events(Event::referenced)},
"""
safety = {mutant.what: mutant.applied_to(CODE) for mutant in mutants.safety_mutants("a.cpp", CODE)}
assert "if (count > 3) count = 0;" in safety["without && known"]
assert "return count < 0;" in safety["without || (known && count(known, 2) == 1)"]
assert "|| (known);" in safety["without && count(known, 2) == 1"]
assert "if (!(count > 3 && known))" in safety["if (not (count > 3 && known))"]
assert "{State::ready, State::ready, events(Event::enable)" in safety["without the way ready to ramping by events(Event::enable)"]
assert "events(Event::enable), {}}" in safety["ready to ramping by events(Event::enable) without unless events(Event::disable, Event::stop)"]
assert "{State::ready, State::ready, {}" in safety["without the way ready to unreferenced by {}"]
assert len(safety) == 7, safety

TABLE = """
      {Fault::not_finite, every, when_gone, coast},
      {Fault::encoder_wire, moving, at_once, coast, true},
"""
watches = mutants.watch_mutants("table.hpp", TABLE)
assert [mutant.what for mutant in watches] == ["without watching not_finite", "without watching encoder_wire"], watches
assert "{Fault::encoder_wire, States{}, at_once, coast, true}," in watches[1].applied_to(TABLE)
assert mutants.watch_mutants("table.hpp", "  X(5, ramping, true)") == []
source = (Path(sys.argv[1]) / "protocol/supervision.hpp").read_text()
rows = source[source.index("condition_table = []"): source.index("std::to_array", source.index("condition_table = []")) + 4000]
assert len(mutants.watch_mutants("supervision.hpp", source)) == rows.count("{Fault::"), "a row is written otherwise"
assert len([mutant for mutant in mutants.way_mutants("supervision.hpp", source) if mutant.what.startswith("without")]) == \
    source.count("    {State::"), "a way is written otherwise"
