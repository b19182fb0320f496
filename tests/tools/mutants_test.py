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
"""
WAYS = """
  { from = "ready", to = "ramping", needs = ["enable"], unless = ["disable", "stop"] },
  { from = "ready", to = "unreferenced", needs = [], unless = ["referenced"] },
"""
safety = {mutant.what: mutant.applied_to(CODE) for mutant in mutants.safety_mutants("a.cpp", CODE)}
assert "if (count > 3) count = 0;" in safety["without && known"]
assert "return count < 0;" in safety["without || (known && count(known, 2) == 1)"]
assert "|| (known);" in safety["without && count(known, 2) == 1"]
assert "if (!(count > 3 && known))" in safety["if (not (count > 3 && known))"]
assert len(safety) == 4, safety
ways = {mutant.what: mutant.applied_to(WAYS) for mutant in mutants.safety_mutants("a.toml", WAYS)}
assert 'from = "ready", to = "ready", needs = ["enable"]' in ways['without the way ready to ramping by ["enable"]']
assert 'needs = ["enable"], unless = [] }' in ways['ready to ramping by ["enable"] without unless ["disable", "stop"]']
assert 'from = "ready", to = "ready", needs = []' in ways["without the way ready to unreferenced by []"]
assert len(ways) == 3, ways

TABLE = """
  { fault = "not_finite", monitored_in = ["every"], clearing = "when_gone", off = "coast" },
  { fault = "encoder_wire", monitored_in = ["moving"], clearing = "at_once", off = "coast", voids_reference = true },
"""
watches = mutants.watch_mutants("table.toml", TABLE)
assert [mutant.what for mutant in watches] == ["without watching not_finite", "without watching encoder_wire"], watches
assert '"encoder_wire", monitored_in = [], clearing' in watches[1].applied_to(TABLE)
assert mutants.watch_mutants("table.toml", '[state.ramping]\nid = 5') == []
source = (Path(sys.argv[1]) / "protocol/tables/supervision.toml").read_text()
assert len(mutants.watch_mutants("supervision.toml", source)) == source.count("fault = \""), "a row is written otherwise"
assert len([mutant for mutant in mutants.way_mutants("supervision.toml", source) if mutant.what.startswith("without")]) == \
    source.count("from = \""), "a way is written otherwise"
