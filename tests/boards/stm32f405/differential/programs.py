"""Random Thumb-2 assembly programs for the Cortex-M4F, run by harness.S.

A program repeats a body of random instructions 32 times. R8 points to the program's memory, R10 is the loop counter,
and SP is preserved. All other registers are free. The result depends only on the random seed, independent of
interrupts.
"""
import random

GENERAL = ["r0", "r1", "r2", "r3", "r4", "r5", "r6", "r7", "r9", "r11", "r12"]
LOW = GENERAL[:8]
CONDITIONS = ["eq", "ne", "cs", "cc", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le"]
OPPOSITE = {a: b for pair in zip(CONDITIONS[::2], CONDITIONS[1::2]) for a, b in (pair, pair[::-1])}
THREE = ["add", "sub", "rsb", "adc", "sbc", "and", "orr", "eor", "bic", "orn"]
DSP_THREE = [sign + name for sign in ("s", "u", "q", "uq", "sh", "uh")
             for name in ("add8", "sub8", "add16", "sub16", "asx", "sax")] + [
    "qadd", "qsub", "qdadd", "qdsub", "sel", "usad8", "smuad", "smuadx", "smusd", "smusdx", "smmul", "smmulr",
    "smulbb", "smulbt", "smultb", "smultt", "smulwb", "smulwt", "mul", "udiv", "sdiv"]
DSP_FOUR = ["mla", "mls", "smlabb", "smlabt", "smlatb", "smlatt", "smlawb", "smlawt", "smlad", "smladx", "smlsd",
            "smlsdx", "smmla", "smmlar", "smmls", "smmlsr", "usada8"]
LONG = ["umull", "smull", "umlal", "smlal", "umaal", "smlalbb", "smlalbt", "smlaltb", "smlaltt", "smlald", "smlaldx",
        "smlsld", "smlsldx"]
FLOAT_THREE = ["vadd", "vsub", "vmul", "vnmul", "vmla", "vmls", "vnmla", "vnmls", "vfma", "vfms", "vfnma", "vfnms",
               "vdiv"]
FLOAT_TWO = ["vabs.f32", "vneg.f32", "vsqrt.f32", "vmov.f32", "vcvt.s32.f32", "vcvt.u32.f32", "vcvtr.s32.f32",
             "vcvtr.u32.f32", "vcvt.f32.s32", "vcvt.f32.u32", "vcvtb.f16.f32", "vcvtt.f16.f32", "vcvtb.f32.f16",
             "vcvtt.f32.f16"]


class Program:
    def __init__(self, number, seed):
        self.number, self.random = number, random.Random(seed)
        self.labels, self.subroutines, self.lines = 0, [], []

    def one_of(self, choices):
        return self.random.choice(choices)

    def general(self):
        return self.one_of(GENERAL)

    def two(self, choices=None):
        return self.random.sample(choices or GENERAL, 2)

    def single(self):
        return f"s{self.random.randrange(32)}"

    def label(self):
        self.labels += 1
        return f"program_{self.number}_{self.labels}"

    def constant(self):
        byte = self.random.randrange(256)
        return self.one_of([byte, byte << self.random.randrange(1, 25), byte * 0x10001, byte * 0x1000100,
                            byte * 0x1010101])

    def shifted(self):
        kind = self.one_of(["", "lsl", "lsr", "asr", "ror", "rrx"])
        if kind == "rrx":
            return f"{self.general()}, rrx"
        return self.general() + (f", {kind} #{self.random.randrange(1, 32)}" if kind else "")

    # In the following methods, `c` is the condition of the returned instruction.
    def arithmetic(self, c, flags):
        r = self.random
        s = self.one_of(["", "s"]) if flags else ""
        form = r.randrange(15)
        if form == 0:
            return f"{self.one_of(THREE)}{s}{c} {self.general()}, {self.general()}, {self.shifted()}"
        if form == 1:
            return f"{self.one_of(THREE)}{s}{c} {self.general()}, {self.general()}, #{self.constant()}"
        if form == 2:
            low = self.one_of(LOW)
            return f"{self.one_of(['add', 'sub'])}{s}{c} {low}, {low}, #{r.randrange(256)}"
        if form == 3:
            a, b = self.two(LOW)
            return f"{self.one_of(['and', 'orr', 'eor', 'bic', 'adc', 'sbc', 'mul'])}{s}{c} {a}, {b}, {a}"
        if form == 4:
            return f"{self.one_of(['lsl', 'lsr', 'asr', 'ror'])}{s}{c} {self.general()}, {self.general()}, " + \
                self.one_of([f"#{r.randrange(1, 32)}", self.general()])
        if form == 5:
            return f"{self.one_of(['mov', 'mvn'])}{s}{c} {self.general()}, {self.one_of([f'#{self.constant()}', self.shifted()])}"
        if form == 6:
            return f"{self.one_of(['movw', 'movt'])}{c} {self.general()}, #{r.randrange(65536)}"
        if form == 7:
            return f"{self.one_of(DSP_THREE)}{c} {self.general()}, {self.general()}, {self.general()}"
        if form == 8:
            return f"{self.one_of(DSP_FOUR)}{c} {', '.join(self.general() for _ in range(4))}"
        if form == 9:
            low, high = self.two()
            return f"{self.one_of(LONG)}{c} {low}, {high}, {self.general()}, {self.general()}"
        if form == 10:
            position = r.randrange(32)
            width = r.randrange(1, 33 - position)
            name = self.one_of(["bfi", "ubfx", "sbfx", "bfc"])
            source = "" if name == "bfc" else f"{self.general()}, "
            return f"{name}{c} {self.general()}, {source}#{position}, #{width}"
        if form == 11:
            name = self.one_of(["clz", "rbit", "rev", "rev16", "revsh", "sxtb", "uxtb", "sxth", "uxth", "sxtb16", "uxtb16"])
            return f"{name}{c} {self.general()}, {self.general()}"
        if form == 12:
            name = self.one_of(["sxtab", "uxtab", "sxtah", "uxtah", "sxtab16", "uxtab16"])
            return f"{name}{c} {self.general()}, {self.general()}, {self.general()}, ror #{self.one_of([8, 16, 24])}"
        if form == 13:
            name, bits = self.one_of([("ssat", r.randrange(1, 33)), ("usat", r.randrange(32))])
            return f"{name}{c} {self.general()}, #{bits}, {self.general()}, {self.one_of(['lsl', 'asr'])} #{r.randrange(1, 32)}"
        name, shift = self.one_of([("pkhbt", "lsl"), ("pkhtb", "asr")])
        return f"{name}{c} {self.general()}, {self.general()}, {self.general()}, {shift} #{r.randrange(1, 32)}"

    def comparison(self, c):
        operand = self.one_of([f"#{self.constant()}", self.general(), self.shifted()])
        return f"{self.one_of(['cmp', 'cmn', 'tst', 'teq'])}{c} {self.general()}, {operand}"

    def access(self, c):
        name, size = self.one_of([("ldr", 4), ("str", 4), ("ldrh", 2), ("ldrsh", 2), ("strh", 2), ("ldrb", 1),
                                  ("ldrsb", 1), ("strb", 1), ("ldrd", 8), ("strd", 8)])
        if size == 8:
            return f"{name}{c} {', '.join(self.two())}, [r8, #{4 * self.random.randrange(-60, 60)}]"
        # Accesses of up to one word may be unaligned.
        return f"{name}{c} {self.general()}, [r8, #{self.random.randrange(-252, 500)}]"

    def float_one(self, c):
        r = self.random
        form = r.randrange(8)
        if form <= 2:
            return f"{self.one_of(FLOAT_THREE)}{c}.f32 {self.single()}, {self.single()}, {self.single()}"
        if form == 3:
            name, types = self.one_of(FLOAT_TWO).split(".", 1)
            return f"{name}{c}.{types} {self.single()}, {self.single()}"
        if form == 4:
            return f"{self.one_of(['vldr', 'vstr'])}{c} {self.single()}, [r8, #{4 * r.randrange(-120, 120)}]"
        if form == 5:
            return self.one_of([f"vmov{c} {self.single()}, {self.general()}", f"vmov{c} {self.general()}, {self.single()}"])
        if form == 6:
            return f"vmov{c}.f32 {self.single()}, #{self.one_of(['1.0', '-0.5', '31.0', '0.125'])}"
        return f"{self.one_of(['vcmp', 'vcmpe'])}{c}.f32 {self.single()}, {self.one_of([self.single(), '#0.0'])}"

    def any_one(self, c="", flags=True):
        kind = self.random.random()
        if kind < 0.5:
            return self.arithmetic(c, flags)
        if kind < 0.6:
            return self.comparison(c)
        if kind < 0.8:
            return self.access(c)
        return self.float_one(c)

    # The following methods return several lines of assembly.
    def if_then(self):
        condition = self.one_of(CONDITIONS)
        pattern = [True] + [self.random.random() < 0.5 for _ in range(self.random.randrange(4))]
        lines = ["it" + "".join("t" if then else "e" for then in pattern[1:]) + " " + condition]
        for i, then in enumerate(pattern):
            c = condition if then else OPPOSITE[condition]
            lines.append(self.any_one(c, flags=False))
        return lines

    def skip(self):
        end = self.label()
        start = self.one_of([f"b{self.one_of(CONDITIONS)} {end}", f"cbz {self.one_of(LOW)}, {end}",
                             f"cbnz {self.one_of(LOW)}, {end}"])
        return [start] + [self.any_one() for _ in range(self.random.randrange(1, 5))] + [f"{end}:"]

    def table(self):
        ends = [self.label() for _ in range(4)]
        base, index = self.label(), self.general()
        lines = [f"and {index}, {self.general()}, #3", f"{base}: tbb [pc, {index}]"]
        lines += [".byte " + ", ".join(f"({end} - {base} - 4) / 2" for end in ends)]
        for end in ends:
            lines += [f"{end}:", self.any_one()]
        return lines

    def call(self):
        name = self.label()
        body = [self.any_one() for _ in range(self.random.randrange(1, 4))]
        saved = sorted(self.random.sample(range(8), 3))
        registers = ", ".join(f"r{i}" for i in saved)
        if self.random.random() < 0.5:
            self.subroutines += [f"{name}:", f"push {{{registers}, lr}}", *body, f"pop {{{registers}, pc}}"]
        else:
            self.subroutines += [f"{name}:", *body, "bx lr"]
        return ["push {lr}", f"bl {name}", "ldr lr, [sp], #4"]

    def several(self):
        base = self.one_of(GENERAL)
        others = [r for r in GENERAL if r != base]
        chosen = sorted(self.random.sample(others, self.random.randrange(2, 6)), key=lambda r: int(r[1:]))
        back = self.one_of(["", "!"])
        name = self.one_of(["ldmia", "ldmdb", "stmia", "stmdb"])
        first = self.random.randrange(20)
        lines = [f"add {base}, r8, #{4 * self.random.randrange(32)}"]
        lines.append(self.one_of([f"{name} {base}{back}, {{{', '.join(chosen)}}}",
                                  f"{self.one_of(['vldmia', 'vstmia'])} {base}{back}, {{s{first}-s{first + self.random.randrange(1, 12)}}}",
                                  f"{self.one_of(['ldr', 'str'])} {chosen[0]}, [{base}, #{4 * self.random.randrange(-9, 9)}]!",
                                  f"{self.one_of(['ldrb', 'strh'])} {chosen[0]}, [{base}], #{self.random.randrange(-99, 99)}"]))
        # The EOR replaces the address in the base register by a random value.
        return lines + [f"eor {base}, {base}, {chosen[0]}"]

    def indexed(self):
        index = self.general()
        return [f"and {index}, {self.general()}, #{self.one_of([0x1C, 0x3F, 0x7C])}",
                f"{self.one_of(['ldr', 'str', 'ldrb', 'ldrsh', 'strh'])} {self.general()}, [r8, {index}, lsl #{self.random.randrange(3)}]"]

    def flags(self):
        r = self.general()
        return self.one_of([[f"mrs {r}, apsr"], [f"msr apsr_nzcvqg, {r}"], [f"mrs {r}, apsr", f"msr apsr_nzcvq, {r}"],
                            ["vmrs apsr_nzcv, fpscr"], [f"vmrs {r}, fpscr"]])

    def exclusive(self):
        again, (value, done), base = self.label(), self.two(LOW), "r9"
        return [f"add {base}, r8, #{4 * self.random.randrange(64)}", f"{again}: ldrex {value}, [{base}]",
                f"adds {value}, #1", f"strex {done}, {value}, [{base}]", f"cmp {done}, #0", f"bne {again}"]

    def stack(self):
        registers = sorted(self.random.sample(range(8), 4))
        names = ", ".join(f"r{i}" for i in registers)
        first = self.random.randrange(24)
        return [f"push {{{names}}}", f"vpush {{s{first}-s{first + 3}}}", self.any_one(), f"vpop {{s{first}-s{first + 3}}}",
                f"pop {{{names}}}"]

    def literal(self):
        return [f"ldr {self.general()}, =0x{self.random.getrandbits(32):08X}"]

    def write(self):
        groups = [self.if_then] * 6 + [self.skip] * 3 + [self.several] * 2 + [
            self.table, self.call, self.indexed, self.flags, self.exclusive, self.stack, self.literal]
        body = []
        for _ in range(self.random.randrange(10, 30)):
            body += self.one_of(groups)() if self.random.random() < 0.5 else [self.any_one()]
        again = self.label()
        # A NOP before half of the programs shifts all instructions by a half word relative to the page boundaries.
        start = ["nop"] if self.random.random() < 0.5 else []
        end = ["sub r10, #1", "cmp r10, #0", f"beq.w {again}_ends", f"b.w {again}", f"{again}_ends: bx lr"]
        return start + [f"{again}:"] + body + end + self.subroutines + [".ltorg"]


def programs(seed, first, count):
    """Returns the assembly source of the programs `first` to `first + count - 1` of this seed."""
    text = [".syntax unified", ".cpu cortex-m4", ".fpu fpv4-sp-d16", ".thumb", ".section .programs, \"ax\""]
    table = [".align 2", ".global programs, program_count", f".equ program_count, {count}", "programs:"]
    for number in range(first, first + count):
        own = f"{seed}-{number}"
        state = random.Random("state" + own)
        text += [".thumb_func", f"program_{number}:", *Program(number, own).write()]
        period = state.randrange(90, 400)
        float_control = state.choice([0, 0, 0, 1 << 22, 2 << 22, 3 << 22, 1 << 24, 1 << 25, 3 << 24])
        table.append(f".word {state.getrandbits(31) + 1}, program_{number} + 1, {period}, {float_control}")
    return "\n".join(text + table) + "\n"
