// Offsets, bits and reset values of the OTG_FS core (RM0090, "OTG_FS control and status registers").
#pragma once

#include <cstdint>

namespace inkwell::virtual_board::otg {

namespace offset {
inline constexpr std::uint32_t gotgctl = 0x000, gotgint = 0x004, gahbcfg = 0x008, gusbcfg = 0x00C, grstctl = 0x010,
                               gintsts = 0x014, gintmsk = 0x018, grxstsr = 0x01C, grxstsp = 0x020, grxfsiz = 0x024,
                               dieptxf0 = 0x028, gccfg = 0x038, cid = 0x03C, dieptxf1 = 0x104, dieptxf3 = 0x10C,
                               dcfg = 0x800, dctl = 0x804, dsts = 0x808, diepmsk = 0x810, doepmsk = 0x814,
                               daint = 0x818, daintmsk = 0x81C, dvbusdis = 0x828, dvbuspulse = 0x82C,
                               diepempmsk = 0x834, in_endpoints = 0x900, out_endpoints = 0xB00, pcgcctl = 0xE00,
                               fifos = 0x1000;
// Read-only description of the synthesised core; not in the manual, but common drivers read it.
inline constexpr std::uint32_t gsnpsid = 0x040, ghwcfg1 = 0x044, ghwcfg2 = 0x048, ghwcfg3 = 0x04C, ghwcfg4 = 0x050;
inline constexpr std::uint32_t fifo_window_bytes = 0x1000, endpoint_bytes = 0x20;
// Within one endpoint's block.
inline constexpr std::uint32_t control = 0x00, interrupts = 0x08, transfer_size = 0x10, fifo_status = 0x18;
}  // namespace offset

namespace reset_value {
inline constexpr std::uint32_t gusbcfg = 0x0000'0A00, grxfsiz = 0x0000'0200, dieptxf0 = 0x0200'0200,
                               dieptxf_first = 0x0200'0400, cid = 0x0000'1200, dcfg = 0x0220'0000, dvbusdis = 0x17D7,
                               dvbuspulse = 0x05B8;
inline constexpr std::uint32_t gsnpsid = 0x4F54'281A, ghwcfg2 = 0x229D'CD20, ghwcfg3 = 0x0200'01E8,
                               ghwcfg4 = 0x0FF0'8030;
}  // namespace reset_value

namespace gotgctl {
inline constexpr std::uint32_t cidsts = 1u << 16, bsvld = 1u << 19;
}
namespace gotgint {
inline constexpr std::uint32_t sedet = 1u << 2, writable = 0x000E'0304;
}
namespace gahbcfg {
inline constexpr std::uint32_t gint = 1u << 0, txfelvl = 1u << 7, writable = 0x181;
}
namespace gusbcfg {
inline constexpr std::uint32_t physel = 1u << 6, fhmod = 1u << 29, fdmod = 1u << 30;
constexpr unsigned trdt(std::uint32_t value) { return (value >> 10) & 0xF; }
}  // namespace gusbcfg
namespace grstctl {
inline constexpr std::uint32_t csrst = 1u << 0, rxfflsh = 1u << 4, txfflsh = 1u << 5, ahbidl = 1u << 31;
constexpr unsigned txfnum(std::uint32_t value) { return (value >> 6) & 0x1F; }
inline constexpr unsigned all_fifos = 0x10;
}  // namespace grstctl
namespace gint {
inline constexpr std::uint32_t otgint = 1u << 2, sof = 1u << 3, rxflvl = 1u << 4, nptxfe = 1u << 5, ginakeff = 1u << 6,
                               gonakeff = 1u << 7, esusp = 1u << 10, usbsusp = 1u << 11, usbrst = 1u << 12,
                               enumdne = 1u << 13, eopf = 1u << 15, iepint = 1u << 18, oepint = 1u << 19,
                               srqint = 1u << 30, wkupint = 1u << 31;
inline constexpr std::uint32_t cleared_by_one = 0xF030'FC0A;
}  // namespace gint
namespace gccfg {
inline constexpr std::uint32_t pwrdwn = 1u << 16, vbusbsen = 1u << 19, novbussens = 1u << 21, writable = 0x003D'0000;
}
namespace dcfg {
inline constexpr std::uint32_t dspd = 0x3, full_speed = 0x3, writable = 0x0000'1FF7;
constexpr unsigned dad(std::uint32_t value) { return (value >> 4) & 0x7F; }
/// End of the periodic part of a frame, in thousandths of it (PFIVL).
constexpr unsigned periodic_frame_per_mille(std::uint32_t value) { return 800 + 50 * ((value >> 11) & 3); }
}  // namespace dcfg
namespace dctl {
inline constexpr std::uint32_t rwusig = 1u << 0, sdis = 1u << 1, ginsts = 1u << 2, gonsts = 1u << 3, sginak = 1u << 7,
                               cginak = 1u << 8, sgonak = 1u << 9, cgonak = 1u << 10, writable = 0x873;
}
namespace dsts {
inline constexpr std::uint32_t suspsts = 1u << 0, full_speed = 3u << 1;
}

/// Bits of DIEPCTL and DOEPCTL.
namespace epctl {
inline constexpr std::uint32_t mpsiz = 0x7FF, usbaep = 1u << 15, dpid = 1u << 16, naksts = 1u << 17, snpm = 1u << 20,
                               stall = 1u << 21, txfnum = 0xFu << 22, cnak = 1u << 26, snak = 1u << 27,
                               sd0pid = 1u << 28, sd1pid = 1u << 29, epdis = 1u << 30, epena = 1u << 31;
constexpr unsigned type(std::uint32_t value) { return (value >> 18) & 3; }
inline constexpr unsigned isochronous = 1;
inline constexpr std::uint32_t type_bits = 3u << 18;
}  // namespace epctl
/// Bits of DIEPINT and DOEPINT.
namespace epint {
inline constexpr std::uint32_t xfrc = 1u << 0, epdisd = 1u << 1, stup = 1u << 3, ittxfe = 1u << 4, otepdis = 1u << 4,
                               inepne = 1u << 6, b2bstup = 1u << 6, txfe = 1u << 7;
}
namespace tsiz {
constexpr std::uint32_t packets(std::uint32_t value, bool control_in) {
  return (value >> 19) & (control_in ? 3 : 0x3FF);
}
}  // namespace tsiz

/// PKTSTS of a word from GRXSTSP.
namespace pktsts {
inline constexpr unsigned global_out_nak = 1, out_data = 2, out_done = 3, setup_done = 4, setup_data = 6;
constexpr unsigned of(std::uint32_t word) { return (word >> 17) & 0xF; }
constexpr unsigned endpoint(std::uint32_t word) { return word & 0xF; }
constexpr unsigned bytes(std::uint32_t word) { return (word >> 4) & 0x7FF; }
}  // namespace pktsts

constexpr std::uint32_t words_for(std::size_t bytes) { return static_cast<std::uint32_t>((bytes + 3) / 4); }

}  // namespace inkwell::virtual_board::otg
