// Registers of a CAN controller (RM0090, CAN_MCR to CAN_FiRx).
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

struct CanRegisters {
  struct : Register {
    Field inrq{"INRQ", 0}, sleep{"SLEEP", 1}, txfp{"TXFP", 2}, rflm{"RFLM", 3}, nart{"NART", 4}, awum{"AWUM", 5},
        abom{"ABOM", 6}, ttcm{"TTCM", 7}, reset{"RESET", 15, 1, Access::rs}, dbf{"DBF", 16};
  } mcr{{"MCR", 0x00, 0x0001'0002}};
  struct : Register {
    Field inak{"INAK", 0, 1, Access::r}, slak{"SLAK", 1, 1, Access::r}, erri{"ERRI", 2, 1, Access::rc_w1},
        wkui{"WKUI", 3, 1, Access::rc_w1}, slaki{"SLAKI", 4, 1, Access::rc_w1}, txm{"TXM", 8, 1, Access::r},
        rxm{"RXM", 9, 1, Access::r}, samp{"SAMP", 10, 1, Access::r}, rx{"RX", 11, 1, Access::r};
  } msr{{"MSR", 0x04, 0x0000'0C02}};
  struct : Register {
    Field rqcp{"RQCP#", 0, 1, Access::rc_w1, {3, 8, 0}}, txok{"TXOK#", 1, 1, Access::rc_w1, {3, 8, 0}},
        alst{"ALST#", 2, 1, Access::rc_w1, {3, 8, 0}}, terr{"TERR#", 3, 1, Access::rc_w1, {3, 8, 0}},
        abrq{"ABRQ#", 7, 1, Access::rs, {3, 8, 0}}, code{"CODE", 24, 2, Access::r},
        tme{"TME#", 26, 1, Access::r, {3, 1, 0}}, low{"LOW#", 29, 1, Access::r, {3, 1, 0}};
  } tsr{{"TSR", 0x08, 0x1C00'0000}};
  struct : Register {
    Field fmp{"FMP#", 0, 2, Access::r}, full{"FULL#", 3, 1, Access::rc_w1}, fovr{"FOVR#", 4, 1, Access::rc_w1},
        rfom{"RFOM#", 5, 1, Access::rs};
  } rfr{{"RF#R", 0x0C, 0, {2, 4, 0}}};
  struct : Register {
    Field tmeie{"TMEIE", 0}, fmpie0{"FMPIE0", 1}, ffie0{"FFIE0", 2}, fovie0{"FOVIE0", 3}, fmpie1{"FMPIE1", 4},
        ffie1{"FFIE1", 5}, fovie1{"FOVIE1", 6}, ewgie{"EWGIE", 8}, epvie{"EPVIE", 9}, bofie{"BOFIE", 10},
        lecie{"LECIE", 11}, errie{"ERRIE", 15}, wkuie{"WKUIE", 16}, slkie{"SLKIE", 17};
  } ier{{"IER", 0x14}};
  struct : Register {
    Field ewgf{"EWGF", 0, 1, Access::r}, epvf{"EPVF", 1, 1, Access::r}, boff{"BOFF", 2, 1, Access::r}, lec{"LEC", 4, 3},
        tec{"TEC", 16, 8, Access::r}, rec{"REC", 24, 8, Access::r};
  } esr{{"ESR", 0x18}};
  struct : Register {
    Field brp{"BRP", 0, 10}, ts1{"TS1", 16, 4}, ts2{"TS2", 20, 3}, sjw{"SJW", 24, 2}, lbkm{"LBKM", 30},
        silm{"SILM", 31};
  } btr{{"BTR", 0x1C}};
  struct : Register {
    Field txrq{"TXRQ", 0}, rtr{"RTR", 1}, ide{"IDE", 2}, exid{"EXID", 3, 18}, stid{"STID", 21, 11};
  } tir{{"TI#R", 0x180, 0, {3, 0x10, 0}}};
  struct : Register {
    Field dlc{"DLC", 0, 4}, tgt{"TGT", 8}, time{"TIME", 16, 16};
  } tdtr{{"TDT#R", 0x184, 0, {3, 0x10, 0}}};
  Register tdlr{"TDL#R", 0x188, 0, {3, 0x10, 0}}, tdhr{"TDH#R", 0x18C, 0, {3, 0x10, 0}};
  struct : Register {
    Field rtr{"RTR", 1, 1, Access::r}, ide{"IDE", 2, 1, Access::r}, exid{"EXID", 3, 18, Access::r},
        stid{"STID", 21, 11, Access::r};
  } rir{{"RI#R", 0x1B0, 0, {2, 0x10, 0}}};
  struct : Register {
    Field dlc{"DLC", 0, 4, Access::r}, fmi{"FMI", 8, 8, Access::r}, time{"TIME", 16, 16, Access::r};
  } rdtr{{"RDT#R", 0x1B4, 0, {2, 0x10, 0}}};
  Register rdlr{"RDL#R", 0x1B8, 0, {2, 0x10, 0}}, rdhr{"RDH#R", 0x1BC, 0, {2, 0x10, 0}};
  struct : Register {
    Field finit{"FINIT", 0}, can2sb{"CAN2SB", 8, 6};
  } fmr{{"FMR", 0x200, 0x2A1C'0E01}};
  struct : Register {
    Field fbm{"FBM#", 0, 1, Access::rw, {28, 1, 0}};
  } fm1r{{"FM1R", 0x204}};
  struct : Register {
    Field fsc{"FSC#", 0, 1, Access::rw, {28, 1, 0}};
  } fs1r{{"FS1R", 0x20C}};
  struct : Register {
    Field ffa{"FFA#", 0, 1, Access::rw, {28, 1, 0}};
  } ffa1r{{"FFA1R", 0x214}};
  struct : Register {
    Field fact{"FACT#", 0, 1, Access::rw, {28, 1, 0}};
  } fa1r{{"FA1R", 0x21C}};
  Register first_filter{"F#R1", 0x240, 0, {28, 8, 0}}, second_filter{"F#R2", 0x244, 0, {28, 8, 0}};
};
inline constexpr CanRegisters can;

}  // namespace inkwell::virtual_board
