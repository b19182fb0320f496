// Registers of the OTG_FS core (RM0090, "OTG_FS control and status registers"). Register offsets are relative to the
// base of the register block.
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

/// GRXSTSR and GRXSTSP. A read of GRXSTSP pops the FIFO entry.
struct OtgReceiveStatus : Register {
  Field epnum{"EPNUM", 0, 4, Access::r}, bcnt{"BCNT", 4, 11, Access::r}, dpid{"DPID", 15, 2, Access::r},
      pktsts{"PKTSTS", 17, 4, Access::r}, frmnum{"FRMNUM", 21, 4, Access::r};
};

/// GRXSTSx.PKTSTS
enum PacketStatus : std::uint32_t { global_out_nak = 1, out_data = 2, out_done = 3, setup_done = 4, setup_data = 6 };

struct OtgGlobalRegisters {
  struct : Register {
    Field cidsts{"CIDSTS", 16, 1, Access::r}, bsvld{"BSVLD", 19, 1, Access::r};
  } gotgctl{{"GOTGCTL", 0x000}};
  struct : Register {
    Field sedet{"SEDET", 2, 1, Access::rc_w1}, srsschg{"SRSSCHG", 8, 1, Access::rc_w1},
        hnsschg{"HNSSCHG", 9, 1, Access::rc_w1}, hngdet{"HNGDET", 17, 1, Access::rc_w1},
        adtochg{"ADTOCHG", 18, 1, Access::rc_w1}, dbcdne{"DBCDNE", 19, 1, Access::rc_w1};
  } gotgint{{"GOTGINT", 0x004}};
  struct : Register {
    Field gint{"GINT", 0}, txfelvl{"TXFELVL", 7}, ptxfelvl{"PTXFELVL", 8};
  } gahbcfg{{"GAHBCFG", 0x008}};
  struct : Register {
    Field physel{"PHYSEL", 6}, trdt{"TRDT", 10, 4}, fhmod{"FHMOD", 29}, fdmod{"FDMOD", 30};
  } gusbcfg{{"GUSBCFG", 0x00C, 0x0000'0A00}};
  struct : Register {
    Field csrst{"CSRST", 0, 1, Access::rs}, rxfflsh{"RXFFLSH", 4, 1, Access::rs}, txfflsh{"TXFFLSH", 5, 1, Access::rs},
        txfnum{"TXFNUM", 6, 5}, ahbidl{"AHBIDL", 31, 1, Access::r};
  } grstctl{{"GRSTCTL", 0x010}};
  struct : Register {
    Field mmis{"MMIS", 1, 1, Access::rc_w1}, otgint{"OTGINT", 2, 1, Access::r}, sof{"SOF", 3, 1, Access::rc_w1},
        rxflvl{"RXFLVL", 4, 1, Access::r}, nptxfe{"NPTXFE", 5, 1, Access::r}, ginakeff{"GINAKEFF", 6, 1, Access::r},
        goutnakeff{"GOUTNAKEFF", 7, 1, Access::r}, esusp{"ESUSP", 10, 1, Access::rc_w1},
        usbsusp{"USBSUSP", 11, 1, Access::rc_w1}, usbrst{"USBRST", 12, 1, Access::rc_w1},
        enumdne{"ENUMDNE", 13, 1, Access::rc_w1}, isoodrp{"ISOODRP", 14, 1, Access::rc_w1},
        eopf{"EOPF", 15, 1, Access::rc_w1}, iepint{"IEPINT", 18, 1, Access::r}, oepint{"OEPINT", 19, 1, Access::r},
        iisoixfr{"IISOIXFR", 20, 1, Access::rc_w1}, incompisoout{"IPXFR_INCOMPISOOUT", 21, 1, Access::rc_w1},
        ptxfe{"PTXFE", 26, 1, Access::r}, cidschg{"CIDSCHG", 28, 1, Access::rc_w1},
        discint{"DISCINT", 29, 1, Access::rc_w1}, srqint{"SRQINT", 30, 1, Access::rc_w1},
        wkupint{"WKUPINT", 31, 1, Access::rc_w1};
  } gintsts{{"GINTSTS", 0x014}};
  struct : Register {
    Field eopfm{"EOPFM", 15};
  } gintmsk{{"GINTMSK", 0x018}};
  OtgReceiveStatus grxstsr{{"GRXSTSR", 0x01C}};
  OtgReceiveStatus grxstsp{{"GRXSTSP", 0x020}};
  struct : Register {
    Field rxfd{"RXFD", 0, 16};
  } grxfsiz{{"GRXFSIZ", 0x024, 0x0000'0200}};
  struct : Register {
    Field tx0fsa{"TX0FSA", 0, 16}, tx0fd{"TX0FD", 16, 16};
  } dieptxf0{{"DIEPTXF0", 0x028, 0x0200'0200}};
  struct : Register {
    Field pwrdwn{"PWRDWN", 16}, vbusasen{"VBUSASEN", 18}, vbusbsen{"VBUSBSEN", 19}, sofouten{"SOFOUTEN", 20},
        novbussens{"NOVBUSSENS", 21};
  } gccfg{{"GCCFG", 0x038}};
  struct : Register {
    Field product_id{"PRODUCT_ID", 0, 32};
  } cid{{"CID", 0x03C, 0x0000'1200}};
  struct : Register {
    Field ineptxsa{"INEPTXSA", 0, 16}, ineptxfd{"INEPTXFD", 16, 16};
  } dieptxf{{"DIEPTXF#", 0x104, 0x0200'0400, {3, 4, 1}}};
};
inline constexpr OtgGlobalRegisters otg_global;

struct OtgDeviceRegisters {
  struct : Register {
    Field dspd{"DSPD", 0, 2}, nzlsohsk{"NZLSOHSK", 2}, dad{"DAD", 4, 7}, pfivl{"PFIVL", 11, 2};
  } dcfg{{"DCFG", 0x000, 0x0220'0000}};
  struct : Register {
    Field rwusig{"RWUSIG", 0}, sdis{"SDIS", 1}, ginsts{"GINSTS", 2, 1, Access::r}, gonsts{"GONSTS", 3, 1, Access::r},
        tctl{"TCTL", 4, 3}, sginak{"SGINAK", 7, 1, Access::w}, cginak{"CGINAK", 8, 1, Access::w},
        sgonak{"SGONAK", 9, 1, Access::w}, cgonak{"CGONAK", 10, 1, Access::w}, poprgdne{"POPRGDNE", 11};
  } dctl{{"DCTL", 0x004}};
  struct : Register {
    Field suspsts{"SUSPSTS", 0, 1, Access::r}, enumspd{"ENUMSPD", 1, 2, Access::r}, fnsof{"FNSOF", 8, 14, Access::r};
  } dsts{{"DSTS", 0x008}};
  Register diepmsk{"DIEPMSK", 0x010}, doepmsk{"DOEPMSK", 0x014};
  struct : Register {
    Field iepint{"IEPINT", 0, 16, Access::r}, oepint{"OEPINT", 16, 16, Access::r};
  } daint{{"DAINT", 0x018}};
  Register daintmsk{"DAINTMSK", 0x01C};
  struct : Register {
    Field vbusdt{"VBUSDT", 0, 16};
  } dvbusdis{{"DVBUSDIS", 0x028, 0x17D7}};
  struct : Register {
    Field dvbusp{"DVBUSP", 0, 12};
  } dvbuspulse{{"DVBUSPULSE", 0x02C, 0x05B8}};
  struct : Register {
    Field ineptxfem{"INEPTXFEM", 0, 16};
  } diepempmsk{{"DIEPEMPMSK", 0x034}};
  struct : Register {
    Field mpsiz{"MPSIZ", 0, 11}, usbaep{"USBAEP", 15}, dpid{"DPID", 16, 1, Access::r},
        naksts{"NAKSTS", 17, 1, Access::r}, eptyp{"EPTYP", 18, 2}, stall{"STALL", 21}, txfnum{"TXFNUM", 22, 4},
        cnak{"CNAK", 26, 1, Access::w}, snak{"SNAK", 27, 1, Access::w}, sd0pid{"SD0PID", 28, 1, Access::w},
        sd1pid{"SD1PID", 29, 1, Access::w}, epdis{"EPDIS", 30, 1, Access::rs}, epena{"EPENA", 31, 1, Access::rs};
  } diepctl{{"DIEPCTL#", 0x100, 0, {4, 0x20, 0}}};
  struct : Register {
    Field xfrc{"XFRC", 0, 1, Access::rc_w1}, epdisd{"EPDISD", 1, 1, Access::rc_w1}, toc{"TOC", 3, 1, Access::rc_w1},
        ittxfe{"ITTXFE", 4, 1, Access::rc_w1}, inepne{"INEPNE", 6, 1, Access::rc_w1}, txfe{"TXFE", 7, 1, Access::r};
  } diepint{{"DIEPINT#", 0x108, 0, {4, 0x20, 0}}};
  struct : Register {
    Field xfrsiz{"XFRSIZ", 0, 19}, pktcnt{"PKTCNT", 19, 10};
  } dieptsiz{{"DIEPTSIZ#", 0x110, 0, {4, 0x20, 0}}};
  struct : Register {
    Field ineptfsav{"INEPTFSAV", 0, 16, Access::r};
  } dtxfsts{{"DTXFSTS#", 0x118, 0, {4, 0x20, 0}}};
  struct : Register {
    Field mpsiz{"MPSIZ", 0, 11}, usbaep{"USBAEP", 15}, dpid{"DPID", 16, 1, Access::r},
        naksts{"NAKSTS", 17, 1, Access::r}, eptyp{"EPTYP", 18, 2}, snpm{"SNPM", 20}, stall{"STALL", 21},
        cnak{"CNAK", 26, 1, Access::w}, snak{"SNAK", 27, 1, Access::w}, sd0pid{"SD0PID", 28, 1, Access::w},
        sd1pid{"SD1PID", 29, 1, Access::w}, epdis{"EPDIS", 30, 1, Access::rs}, epena{"EPENA", 31, 1, Access::rs};
  } doepctl{{"DOEPCTL#", 0x300, 0, {4, 0x20, 0}}};
  struct : Register {
    Field xfrc{"XFRC", 0, 1, Access::rc_w1}, epdisd{"EPDISD", 1, 1, Access::rc_w1}, stup{"STUP", 3, 1, Access::rc_w1},
        otepdis{"OTEPDIS", 4, 1, Access::rc_w1}, b2bstup{"B2BSTUP", 6, 1, Access::rc_w1};
  } doepint{{"DOEPINT#", 0x308, 0, {4, 0x20, 0}}};
  struct : Register {
    Field xfrsiz{"XFRSIZ", 0, 19}, pktcnt{"PKTCNT", 19, 10}, stupcnt{"STUPCNT", 29, 2};
  } doeptsiz{{"DOEPTSIZ#", 0x310, 0, {4, 0x20, 0}}};
};
inline constexpr OtgDeviceRegisters otg_device;
inline constexpr std::uint32_t otg_device_base = 0x800;

/// DCFG.DSPD and DSTS.ENUMSPD
inline constexpr std::uint32_t otg_full_speed = 3;
/// DxEPCTL.EPTYP
inline constexpr std::uint32_t otg_control = 0, otg_isochronous = 1;
/// GRSTCTL.TXFNUM
inline constexpr std::uint32_t all_transmit_fifos = 0x10;

struct OtgPowerRegisters {
  struct : Register {
    Field stppclk{"STPPCLK", 0}, gatehclk{"GATEHCLK", 1}, physusp{"PHYSUSP", 4};
  } pcgcctl{{"PCGCCTL", 0x000}};
};
inline constexpr OtgPowerRegisters otg_power;
inline constexpr std::uint32_t otg_power_base = 0xE00;

/// This structure contains all register blocks.
struct OtgRegisters : OtgGlobalRegisters, OtgDeviceRegisters, OtgPowerRegisters {};
inline constexpr OtgRegisters otg;

/// Read-only synthesis configuration of the core. Common drivers read these undocumented registers.
struct OtgSynthesisRegisters {
  Register gsnpsid{"GSNPSID", 0x040, 0x4F54'281A}, ghwcfg1{"GHWCFG1", 0x044}, ghwcfg2{"GHWCFG2", 0x048, 0x229D'CD20},
      ghwcfg3{"GHWCFG3", 0x04C, 0x0200'01E8}, ghwcfg4{"GHWCFG4", 0x050, 0x0FF0'8030};
};
inline constexpr OtgSynthesisRegisters otg_synthesis;

/// Address windows for FIFO access, one window per endpoint.
inline constexpr std::uint32_t otg_fifo_base = 0x1000, otg_fifo_window_bytes = 0x1000;

}  // namespace inkwell::virtual_board
