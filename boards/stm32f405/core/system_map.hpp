// Registers of the Cortex-M4 core (ARMv7-M Architecture Reference Manual, B3.2 to B3.5, C1.6 to C1.8) and of the DBGMCU
// (RM0090, "Debug support"). Register offsets are relative to the base address after each map.
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

struct TraceRegisters {
  struct : Register {
    Field cyccntena{"CYCCNTENA", 0};
  } ctrl{{"CTRL", 0x00, 0x4000'0000}};
  Register cyccnt{"CYCCNT", 0x04}, lar{"LAR", 0xFB0};
};
inline constexpr TraceRegisters dwt;
inline constexpr std::uint32_t dwt_base = 0xE000'1000;

struct ControllerTypeRegisters {
  struct : Register {
    Field intlinesnum{"INTLINESNUM", 0, 4, Access::r};
  } ictr{{"ICTR", 0x04, 2}};
  struct : Register {
    Field dismcycint{"DISMCYCINT", 0}, disdefwbuf{"DISDEFWBUF", 1}, disfold{"DISFOLD", 2}, disfpca{"DISFPCA", 8},
        disoofp{"DISOOFP", 9};
  } actlr{{"ACTLR", 0x08}};
};
inline constexpr ControllerTypeRegisters scs;
inline constexpr std::uint32_t scs_base = 0xE000'E000;

struct SysTickRegisters {
  struct : Register {
    Field enable{"ENABLE", 0}, tickint{"TICKINT", 1}, clksource{"CLKSOURCE", 2},
        countflag{"COUNTFLAG", 16, 1, Access::r};
  } ctrl{{"CTRL", 0x00}};
  struct : Register {
    Field reload{"RELOAD", 0, 24};
  } load{{"LOAD", 0x04}};
  struct : Register {
    Field current{"CURRENT", 0, 24};
  } val{{"VAL", 0x08}};
  struct : Register {
    Field tenms{"TENMS", 0, 24, Access::r}, skew{"SKEW", 30, 1, Access::r}, noref{"NOREF", 31, 1, Access::r};
  } calib{{"CALIB", 0x0C, 0xC000'0000}};
};
inline constexpr SysTickRegisters stk;
inline constexpr std::uint32_t stk_base = 0xE000'E010, stk_bytes = 0x10;

struct NvicRegisters {
  Register iser{"ISER#", 0x000, 0, {3, 4}}, icer{"ICER#", 0x080, 0, {3, 4}}, ispr{"ISPR#", 0x100, 0, {3, 4}},
      icpr{"ICPR#", 0x180, 0, {3, 4}}, iabr{"IABR#", 0x200, 0, {3, 4}}, ipr{"IPR#", 0x300, 0, {21, 4}};
};
inline constexpr NvicRegisters nvic_registers;
inline constexpr std::uint32_t nvic_base = 0xE000'E100, nvic_bytes = 0x400;

struct SystemControlRegisters {
  Register cpuid{"CPUID", 0x00, 0x410F'C241};
  struct : Register {
    Field vectactive{"VECTACTIVE", 0, 9, Access::r}, rettobase{"RETTOBASE", 11, 1, Access::r},
        vectpending{"VECTPENDING", 12, 7, Access::r}, isrpending{"ISRPENDING", 22, 1, Access::r},
        pendstclr{"PENDSTCLR", 25, 1, Access::w}, pendstset{"PENDSTSET", 26, 1, Access::rs},
        pendsvclr{"PENDSVCLR", 27, 1, Access::w}, pendsvset{"PENDSVSET", 28, 1, Access::rs},
        nmipendset{"NMIPENDSET", 31, 1, Access::rs};
  } icsr{{"ICSR", 0x04}};
  struct : Register {
    Field tbloff{"TBLOFF", 7, 25};
  } vtor{{"VTOR", 0x08}};
  struct : Register {
    Field vectreset{"VECTRESET", 0, 1, Access::w}, sysresetreq{"SYSRESETREQ", 2, 1, Access::w},
        prigroup{"PRIGROUP", 8, 3}, vectkey{"VECTKEY", 16, 16, Access::w};
  } aircr{{"AIRCR", 0x0C, 0xFA05'0000}};
  struct : Register {
    Field sleeponexit{"SLEEPONEXIT", 1}, sleepdeep{"SLEEPDEEP", 2}, sevonpend{"SEVONPEND", 4};
  } scr{{"SCR", 0x10}};
  struct : Register {
    Field nonbasethrdena{"NONBASETHRDENA", 0}, usersetmpend{"USERSETMPEND", 1}, unalign_trp{"UNALIGN_TRP", 3},
        div_0_trp{"DIV_0_TRP", 4}, bfhfnmign{"BFHFNMIGN", 8}, stkalign{"STKALIGN", 9};
  } ccr{{"CCR", 0x14, 0x200}};
  /// Priorities of the system handlers 4 to 15, one byte for each handler.
  Register shpr{"SHPR#", 0x18, 0, {3, 4, 1}};
  struct : Register {
    Field memfaultact{"MEMFAULTACT", 0}, busfaultact{"BUSFAULTACT", 1}, usgfaultact{"USGFAULTACT", 3},
        svcallact{"SVCALLACT", 7}, monitoract{"MONITORACT", 8}, pendsvact{"PENDSVACT", 10},
        systickact{"SYSTICKACT", 11}, usgfaultpended{"USGFAULTPENDED", 12}, memfaultpended{"MEMFAULTPENDED", 13},
        busfaultpended{"BUSFAULTPENDED", 14}, svcallpended{"SVCALLPENDED", 15}, memfaultena{"MEMFAULTENA", 16},
        busfaultena{"BUSFAULTENA", 17}, usgfaultena{"USGFAULTENA", 18};
  } shcsr{{"SHCSR", 0x24}};
  struct : Register {
    Field iaccviol{"IACCVIOL", 0, 1, Access::rc_w1}, daccviol{"DACCVIOL", 1, 1, Access::rc_w1},
        munstkerr{"MUNSTKERR", 3, 1, Access::rc_w1}, mstkerr{"MSTKERR", 4, 1, Access::rc_w1},
        mlsperr{"MLSPERR", 5, 1, Access::rc_w1}, mmarvalid{"MMARVALID", 7, 1, Access::rc_w1},
        ibuserr{"IBUSERR", 8, 1, Access::rc_w1}, preciserr{"PRECISERR", 9, 1, Access::rc_w1},
        unstkerr{"UNSTKERR", 11, 1, Access::rc_w1}, stkerr{"STKERR", 12, 1, Access::rc_w1},
        lsperr{"LSPERR", 13, 1, Access::rc_w1}, bfarvalid{"BFARVALID", 15, 1, Access::rc_w1},
        undefinstr{"UNDEFINSTR", 16, 1, Access::rc_w1}, invstate{"INVSTATE", 17, 1, Access::rc_w1},
        invpc{"INVPC", 18, 1, Access::rc_w1}, nocp{"NOCP", 19, 1, Access::rc_w1},
        unaligned{"UNALIGNED", 24, 1, Access::rc_w1}, divbyzero{"DIVBYZERO", 25, 1, Access::rc_w1};
  } cfsr{{"CFSR", 0x28}};
  struct : Register {
    Field vecttbl{"VECTTBL", 1, 1, Access::rc_w1}, forced{"FORCED", 30, 1, Access::rc_w1},
        debugevt{"DEBUGEVT", 31, 1, Access::rc_w1};
  } hfsr{{"HFSR", 0x2C}};
  Register dfsr{"DFSR", 0x30}, mmfar{"MMFAR", 0x34}, bfar{"BFAR", 0x38}, afsr{"AFSR", 0x3C};
};
inline constexpr SystemControlRegisters scb;
inline constexpr std::uint32_t scb_base = 0xE000'ED00;

struct CoprocessorRegisters {
  struct : Register {
    Field cp{"CP", 20, 4};
  } cpacr{{"CPACR", 0x00}};
};
inline constexpr CoprocessorRegisters fpu_cpacr;
inline constexpr std::uint32_t fpu_cpacr_base = 0xE000'ED88;

struct CoreDebugRegisters {
  struct : Register {
    Field c_debugen{"C_DEBUGEN", 0, 1, Access::r};
  } dhcsr{{"DHCSR", 0x00}};
  struct : Register {
    Field vc_corereset{"VC_CORERESET", 0}, vc_mmerr{"VC_MMERR", 4}, vc_nocperr{"VC_NOCPERR", 5},
        vc_chkerr{"VC_CHKERR", 6}, vc_staterr{"VC_STATERR", 7}, vc_buserr{"VC_BUSERR", 8}, vc_interr{"VC_INTERR", 9},
        vc_harderr{"VC_HARDERR", 10}, mon_en{"MON_EN", 16}, mon_pend{"MON_PEND", 17}, mon_step{"MON_STEP", 18},
        mon_req{"MON_REQ", 19}, trcena{"TRCENA", 24};
  } demcr{{"DEMCR", 0x0C}};
};
inline constexpr CoreDebugRegisters core_debug;
inline constexpr std::uint32_t core_debug_base = 0xE000'EDF0;

struct SoftwareTriggerRegisters {
  struct : Register {
    Field intid{"INTID", 0, 9, Access::w};
  } stir{{"STIR", 0x00}};
};
inline constexpr SoftwareTriggerRegisters nvic_stir;
inline constexpr std::uint32_t nvic_stir_base = 0xE000'EF00;

struct FloatContextRegisters {
  struct : Register {
    Field lspact{"LSPACT", 0}, user{"USER", 1}, thread{"THREAD", 3}, hfrdy{"HFRDY", 4}, mmrdy{"MMRDY", 5},
        bfrdy{"BFRDY", 6}, monrdy{"MONRDY", 8}, lspen{"LSPEN", 30}, aspen{"ASPEN", 31};
  } fpccr{{"FPCCR", 0x00, 0xC000'0000}};
  struct : Register {
    Field address{"ADDRESS", 3, 29};
  } fpcar{{"FPCAR", 0x04}};
  Register fpdscr{"FPDSCR", 0x08}, mvfr0{"MVFR0", 0x0C, 0x1011'0021}, mvfr1{"MVFR1", 0x10, 0x1100'0011};
};
inline constexpr FloatContextRegisters fpu;
inline constexpr std::uint32_t fpu_base = 0xE000'EF34;

struct DebugSupportRegisters {
  Register idcode{"DBGMCU_IDCODE", 0x00, 0x1007'6413};  ///< STM32F405, revision 1
  struct : Register {
    Field dbg_sleep{"DBG_SLEEP", 0};
  } cr{{"DBGMCU_CR", 0x04}};
  Register apb1_fz{"DBGMCU_APB1_FZ", 0x08}, apb2_fz{"DBGMCU_APB2_FZ", 0x0C};
};
inline constexpr DebugSupportRegisters dbg;
inline constexpr std::uint32_t dbg_base = 0xE004'2000;

}  // namespace inkwell::virtual_board
