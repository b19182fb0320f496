#!/usr/bin/env python3
"""Checks both descriptions of the chip's registers, the firmware's and the emulator's, against an SVD file.

    tools/check/check_registers.py STM32F405.svd --firmware OBJECT --chip JSON

OBJECT is an object file with the firmware's register map and debug information, which describes every register and
field (tests/firmware/registers/CMakeLists.txt builds it). JSON is the output of the program print-chip-registers, with
the emulator's declarations. Each of the two is optional.

The script compares every register address and every field position and width with the SVD. SVD files contain errors and
gaps. The known ones are listed below with reasons and are printed as such. A known difference that no longer occurs is
also an error.

Exit code 0: no differences, or only known ones. 1: differences, one line each. 2: the input cannot be read.
"""

import argparse
import dataclasses
import pathlib
import re
import sys

from register_maps import DebugInformation, Field, Peripheral, Register, SvdRegister, Unreadable, read_chip, read_svd

# ---- known deviations of the SVD of the STM32F405 --------------------------------------------------------------


@dataclasses.dataclass
class Known:
    """A known difference with its reason. Patterns match whole names of our maps. `field` is None for a whole register,
    and `register` is None for a whole peripheral. `svd_name` is the name in the SVD, with `|` between several views of
    a register. It is None if nothing is comparable."""

    peripheral: str
    register: str | None
    field: str | None
    svd_name: str | None
    reason: str
    uses: int = 0

    def applies(self, *names: str) -> bool:
        patterns = [pattern for pattern in (self.peripheral, self.register, self.field) if pattern is not None]
        return len(patterns) == len(names) and all(map(re.fullmatch, patterns, names))

    def concerns(self, peripheral) -> bool:
        """True if the peripheral contains the register and field of this difference."""
        return bool(re.fullmatch(self.peripheral, peripheral.name)) and (
            self.register is None or any(re.fullmatch(self.register, r.name) and (
                self.field is None or any(re.fullmatch(self.field, f.name) for f in r.fields))
                for r in peripheral.registers)
        )

    def rename(self, name: str) -> str:
        """Returns the name in the SVD; `{}` in it is replaced by our name."""
        return self.svd_name.format(name)


FS_PREFIX = "the SVD puts FS_ before most names of this core"
VIEWS = "the SVD has one view of it for output and one for input"
IN_CPP = "a field cannot have its register's name in C++"
ENDPOINT_0 = "endpoint 0 has a narrower field (packet size as a code, few packets); no more of it is used"
NOT_ON_0 = "endpoint 0 has no data toggle to set or read; it is not used there"
BOTH_MEANINGS = "the SVD has both its meanings, for isochronous endpoints and the others"


def known_differences() -> list[Known]:
    return [
        Known("ADC_COMMON", None, None, "C_ADC", "the SVD's name for what the three converters share"),
        Known("FLASH_PROGRAMMING", None, None, "FLASH", "the part of the flash's registers that a driver owns"),
        Known("SIGNATURE", None, None, None, 'not in the SVD; RM0090, "Unique device ID register": 0x1FFF7A10'),
        Known("CORE_DEBUG", None, None, None, "not in the SVD; ARMv7-M Architecture Reference Manual: DEMCR at 0xE000EDFC"),
        Known("DWT", None, None, None, "not in the SVD; ARMv7-M Architecture Reference Manual: DWT_CTRL at 0xE0001000"),
        Known("OTG_FS_FIFO", None, None, None, 'not in the SVD; RM0090, "Data FIFO (DFIFO) access register map": 0x50001000'),
        Known(r"TIM\d+", "CCMR[12]", None, "{0}_Output|{0}_Input", VIEWS),
        Known(r"TIM\d+", "CCMR1", "IC1PSC", "ICPCS", "a misspelling in the SVD"),
        Known(r"TIM\d+", "CCMR1", "IC2PSC", "IC2PCS", "a misspelling in the SVD"),
        Known("TIM(9|12)", "CCMR1", "IC[12]F", None, "the SVD has three bits; RM0090, TIM9 and TIM12: four"),
        Known("ADC[123]", "SMPR[12]", r"SMP\d+", None, "the SVD has the register as one field"),
        Known("ADC_COMMON", "CCR", "MULTI", "MULT", "RM0090 calls it MULTI"),
        Known("SYSCFG", "MEMRMP", None, "MEMRM", "RM0090 calls it SYSCFG_MEMRMP"),
        Known("CRC", "CR", "RESET", "CR", "the SVD gives it the register's name"),
        Known("RCC", "PLLI2SCFGR", "PLLI2S[NR]", "{}x", "the SVD has an x behind it"),
        Known("RCC", "CSR", "PINRSTF", "PADRSTF", "RM0090 calls the pin's flag PINRSTF"),
        Known("SCS", None, None, None, "not in the SVD, but for ACTLR; ARMv7-M Architecture Reference Manual, B3.2.2"),
        Known("SCB", "SHCSR", None, "SHCRS", "a misspelling in the SVD"),
        Known("SCB", "VTOR", "TBLOFF", None, "the SVD has bits 9 to 29; ARMv7-M has 7 to 31, with 1 to 3 kept at 0"),
        Known("SCB", "SCR", "SEVONPEND", "SEVEONPEND", "a misspelling in the SVD"),
        Known("SCB", "CCR", "UNALIGN_TRP", "UNALIGN__TRP", "a misspelling in the SVD"),
        Known("SCB", "CFSR", "DACCVIOL", "IACCVIOL", "the SVD calls it IACCVIOL; ARMv7-M, B3.2.15: DACCVIOL"),
        Known("SCB", "CFSR", "IACCVIOL", None, "the SVD has it at bit 1; ARMv7-M, B3.2.15: bit 0"),
        Known("SCB", "HFSR", "DEBUGEVT", "DEBUG_VT", "ARMv7-M calls it DEBUGEVT"),
        Known("SCB", "DFSR", None, None, "not in the SVD; ARMv7-M: 0xE000ED30"),
        Known("MPU", "CTRL|RNR|RBAR|RASR", None, "MPU_{}", "the SVD repeats the unit's name"),
        Known("FPU", "FPDSCR", None, None, "the SVD has a register of the core there; ARMv7-M: FPDSCR at 0xE000EF3C"),
        Known("FPU", "MVFR[01]", None, None, "not in the SVD; ARMv7-M: 0xE000EF40 and 0xE000EF44"),
        Known("SCB", "CFSR", None, "CFSR_UFSR_BFSR_MMFSR", "the SVD spells out the three status registers in it"),
        Known("NVIC", "IPR20", None, None, "the SVD ends with interrupt 79; RM0090's vector table with 81"),
        Known("OTG_FS_GLOBAL", "GRXSTSR", None, "FS_GRXSTSR_Device", "the SVD has two views of it"),
        Known("OTG_FS_GLOBAL", "G(?!RXSTSP).*|CID|DIEPTXF[1-3]", None, "FS_{}", FS_PREFIX),
        Known("OTG_FS_GLOBAL", "GRXSTSP", None, None, "the SVD has only GRXSTSR, which does not pop; RM0090: 0x50000020"),
        Known("OTG_FS_GLOBAL", "DIEPTXF0", None, "FS_GNPTXFSIZ_Device", "the SVD has its name in host mode"),
        Known("OTG_FS_DEVICE", "DCFG|DCTL|DSTS|D[IO]EPMSK|DAINT|DAINTMSK|DIEPCTL0", None, "FS_{}", FS_PREFIX),
        Known("OTG_FS_PWRCLK", "PCGCCTL", None, "FS_{}", FS_PREFIX),
        Known("RCC", "CSR", "IWDGRSTF", "WDGRSTF", "RM0090 calls the independent watchdog's flag IWDGRSTF"),
        Known("DBG", "DBGMCU_APB1_FZ", "DBG_IWDG_STOP", "DBG_IWDEG_STOP", "a misspelling in the SVD"),
        Known("IWDG", "PR", "PR_", "PR", IN_CPP),
        Known("PWR", "CR", "VOS", None, "not in the SVD; RM0090, PWR_CR of the STM32F405: bit 14"),
        Known("RCC", "AHB1ENR", "CCMDATARAMEN", None, "not in the SVD; RM0090, RCC_AHB1ENR of the STM32F405: bit 20"),
        Known("SCB", "AIRCR", "VECTKEY", "VECTKEYSTAT", "the SVD has the name for reading"),
        Known("OTG_FS_GLOBAL", "GCCFG", "NOVBUSSENS", None, "not in the SVD; RM0090, OTG_FS_GCCFG: bit 21"),
        Known("OTG_FS_DEVICE", "DIEPCTL[1-3]|DOEPCTL[0-3]", "STALL", "Stall", "the SVD has it in small letters"),
        Known("OTG_FS_DEVICE", "D[IO]EPCTL[1-3]", "SD0PID", "SD0PID_SEVNFRM", BOTH_MEANINGS),
        Known("OTG_FS_DEVICE", "DIEPCTL1", "SD1PID", "SODDFRM_SD1PID", BOTH_MEANINGS),
        Known("OTG_FS_DEVICE", "DIEPCTL[23]|DOEPCTL[1-3]", "SD1PID", "SODDFRM", "the SVD has its other meaning"),
        Known("OTG_FS_DEVICE", "D[IO]EPCTL[1-3]", "DPID", "EONUM_DPID", BOTH_MEANINGS),
        Known("OTG_FS_DEVICE", "DOEPTSIZ[1-3]", "STUPCNT", "RXDPID_STUPCNT", BOTH_MEANINGS),
        Known("OTG_FS_DEVICE", "D[IO]EPCTL0", "SD[01]PID|DPID", None, NOT_ON_0),
        Known("OTG_FS_DEVICE", "D[IO]EPCTL0", "MPSIZ", None, ENDPOINT_0),
        Known("OTG_FS_DEVICE", "D[IO]EPTSIZ0", "XFRSIZ|PKTCNT", None, ENDPOINT_0),
    ]


# ---- comparison ------------------------------------------------------------------------------------------------


class Comparison:
    def __init__(self, svd):
        self.svd = svd
        self.known = known_differences()
        self.differences: list[str] = []
        self.registers = 0
        self.fields = 0

    def svd_name(self, *names: str) -> str | None:
        """Returns the SVD name of the peripheral, register or field `names`; None if it is not comparable."""
        for known in self.known:
            if known.applies(*names):
                known.uses += 1
                return None if known.svd_name is None else known.rename(names[-1])
        return names[-1]

    def compare(self, whose: str, peripherals: list[Peripheral]) -> None:
        for peripheral in peripherals:
            kin = [other for other in peripherals if other is not peripheral and other.form() == peripheral.form()]
            self.compare_peripheral(whose, peripheral, kin)

    def svd_views(self, peripheral: Peripheral, register: str) -> list[SvdRegister] | None:
        """Returns the SVD's views of a register; None if it is not comparable."""
        name, wanted = self.svd_name(peripheral.name), self.svd_name(peripheral.name, register)
        if name is None or wanted is None:
            return None
        registers = self.svd[name][1] if name in self.svd else []
        return [candidate for candidate in registers if candidate.name in wanted.split("|")]

    def compare_peripheral(self, whose: str, peripheral: Peripheral, kin: list[Peripheral]) -> None:
        name = self.svd_name(peripheral.name)
        if name is None:
            return
        if name not in self.svd:
            self.differences.append(f"{whose} {peripheral.name}: the SVD has no peripheral {name}")
            return
        if self.svd[name][0] != peripheral.base:
            self.differences.append(
                f"{whose} {peripheral.name} is at 0x{peripheral.base:08X}, in the SVD at 0x{self.svd[name][0]:08X}"
            )
            return
        for register in peripheral.registers:
            self.compare_register(whose, peripheral, register, kin)

    def compare_register(self, whose: str, peripheral: Peripheral, register: Register, kin: list[Peripheral]) -> None:
        label = f"{whose} {peripheral.name}.{register.name}"
        views = self.svd_views(peripheral, register.name)
        if views is None:
            return
        if not views:
            # Peripherals of one kind share a description, so a peripheral may lack a described register.
            if not any(self.svd_views(other, register.name) for other in kin):
                self.differences.append(f"{label}: the SVD has no such register in {peripheral.name}")
            return
        self.registers += 1
        for view in views:
            if view.address != register.address:
                self.differences.append(
                    f"{label} is at 0x{register.address:08X}, in the SVD at 0x{view.address:08X}"
                )
                return
        for field in register.fields:
            self.compare_field(label, peripheral, register.name, field, kin)

    def svd_position(self, peripheral: Peripheral, register: str, field: str) -> tuple[int, int] | None:
        name = self.svd_name(peripheral.name, register, field)
        for view in self.svd_views(peripheral, register) or []:
            if name is not None and (position := view.fields.get(name) or gathered(view.fields, name)):
                return position
        return None

    def compare_field(self, label: str, peripheral: Peripheral, register: str, field: Field, kin) -> None:
        if self.svd_name(peripheral.name, register, field.name) is None:
            return
        self.fields += 1
        position = self.svd_position(peripheral, register, field.name)
        if position is None:
            position = next(filter(None, (self.svd_position(other, register, field.name) for other in kin)), None)
        if position is None:
            self.differences.append(f"{label}: the SVD has no field {field.name} there")
        elif position != (field.position, field.width):
            self.differences.append(
                f"{label}.{field.name} is at bit {field.position}, {field.width} wide; "
                f"in the SVD at bit {position[0]}, {position[1]} wide"
            )


def gathered(fields: dict[str, tuple[int, int]], name: str) -> tuple[int, int] | None:
    """Returns the position of a field that the SVD describes as adjacent single bits, such as PLLN0 to PLLN8."""
    bits = {int(match[1]): position for key, position in fields.items() if (match := re.fullmatch(rf"{name}(\d)", key))}
    if not bits or sorted(bits) != list(range(len(bits))):
        return None
    if any(position != (bits[0][0] + bit, 1) for bit, position in bits.items()):
        return None
    return bits[0][0], len(bits)


def unused(comparison: Comparison, peripherals: list[Peripheral]) -> list[str]:
    """Known differences of existing peripherals that did not occur, because the SVD or a map has changed."""
    return [
        f"the known difference of {known.peripheral} {known.register or ''} {known.field or ''} does not occur; "
        f"remove it from {pathlib.Path(__file__).name}"
        for known in comparison.known
        if known.uses == 0 and any(known.concerns(peripheral) for peripheral in peripherals)
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description="Checks both register maps against an SVD file.")
    parser.add_argument("svd", type=pathlib.Path, help="SVD file of the STM32F405")
    parser.add_argument("--firmware", type=pathlib.Path, help="object file with the firmware's register map")
    parser.add_argument("--chip", type=pathlib.Path, help="what print-chip-registers prints")
    arguments = parser.parse_args()
    try:
        comparison = Comparison(read_svd(arguments.svd))
        maps = {}
        if arguments.firmware:
            maps["firmware"] = DebugInformation(arguments.firmware).peripherals()
        if arguments.chip:
            maps["chip"] = read_chip(arguments.chip)
    except Unreadable as error:
        print(error, file=sys.stderr)
        return 2
    for whose, peripherals in maps.items():
        comparison.compare(whose, peripherals)
    together = [peripheral for peripherals in maps.values() for peripheral in peripherals]
    used = [known for known in comparison.known if known.uses]
    for known in used:
        name = ".".join(pattern for pattern in (known.peripheral, known.register, known.field) if pattern)
        print(f"known: {name}: {known.reason}")
    problems = comparison.differences + unused(comparison, together)
    for problem in problems:
        print(f"DIFFERS: {problem}")
    print(
        f"{len(together)} peripherals, {comparison.registers} registers and {comparison.fields} fields compared: "
        f"{len(problems)} differences, {len(used)} known ones"
    )
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
