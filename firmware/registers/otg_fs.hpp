// USB on-the-go full-speed, in device mode (RM0090, chapter OTG_FS).
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct UsbGlobal {
  struct GUSBCFG : Register<base + 0x0C> {
    using PHYSEL = Field<GUSBCFG, 6, 1>;
    using TRDT = Field<GUSBCFG, 10, 4>;
    using FDMOD = Field<GUSBCFG, 30, 1>;
  };
  struct GRSTCTL : Register<base + 0x10> {
    using CSRST = Field<GRSTCTL, 0, 1>;
    using RXFFLSH = Field<GRSTCTL, 4, 1>;
    using TXFFLSH = Field<GRSTCTL, 5, 1>;
    using TXFNUM = Field<GRSTCTL, 6, 5>;
    using AHBIDL = Field<GRSTCTL, 31, 1>;
  };
  struct GINTSTS : Register<base + 0x14> {
    using RXFLVL = Field<GINTSTS, 4, 1>;
    using USBRST = Field<GINTSTS, 12, 1>;
    using ENUMDNE = Field<GINTSTS, 13, 1>;
  };
  struct GRXSTSR : Register<base + 0x1C> {
    using EPNUM = Field<GRXSTSR, 0, 4>;
    using PKTSTS = Field<GRXSTSR, 17, 4>;
  };
  struct GRXSTSP : Register<base + 0x20> {
    using EPNUM = Field<GRXSTSP, 0, 4>;
    using BCNT = Field<GRXSTSP, 4, 11>;
    using PKTSTS = Field<GRXSTSP, 17, 4>;
  };
  struct GRXFSIZ : Register<base + 0x24> {
    using RXFD = Field<GRXFSIZ, 0, 16>;
  };
  struct DIEPTXF0 : Register<base + 0x28> {
    using TX0FSA = Field<DIEPTXF0, 0, 16>;
    using TX0FD = Field<DIEPTXF0, 16, 16>;
  };
  struct GCCFG : Register<base + 0x38> {
    using PWRDWN = Field<GCCFG, 16, 1>;
    using NOVBUSSENS = Field<GCCFG, 21, 1>;
  };
  struct DIEPTXF1 : Register<base + 0x104> {
    using INEPTXSA = Field<DIEPTXF1, 0, 16>;
    using INEPTXFD = Field<DIEPTXF1, 16, 16>;
  };
  struct DIEPTXF2 : Register<base + 0x108> {
    using INEPTXSA = Field<DIEPTXF2, 0, 16>;
    using INEPTXFD = Field<DIEPTXF2, 16, 16>;
  };
  struct DIEPTXF3 : Register<base + 0x10C> {
    using INEPTXSA = Field<DIEPTXF3, 0, 16>;
    using INEPTXFD = Field<DIEPTXF3, 16, 16>;
  };
};

template <std::uint32_t base>
struct UsbDevice {
  struct DCFG : Register<base + 0x00> {
    using DSPD = Field<DCFG, 0, 2>;
    using DAD = Field<DCFG, 4, 7>;
  };
  struct DCTL : Register<base + 0x04> {
    using SDIS = Field<DCTL, 1, 1>;
    using CGINAK = Field<DCTL, 8, 1>;
  };
  struct DSTS : Register<base + 0x08> {
    using SUSPSTS = Field<DSTS, 0, 1>;
    using FNSOF = Field<DSTS, 8, 14>;
  };
  struct DIEPCTL : RegisterArray<base + 0x100, 0x20, 4> {
    using MPSIZ = Field<DIEPCTL, 0, 11>;
    using USBAEP = Field<DIEPCTL, 15, 1>;
    using EPTYP = Field<DIEPCTL, 18, 2>;
    using STALL = Field<DIEPCTL, 21, 1>;
    using TXFNUM = Field<DIEPCTL, 22, 4>;
    using CNAK = Field<DIEPCTL, 26, 1>;
    using SNAK = Field<DIEPCTL, 27, 1>;
    using SD0PID = Field<DIEPCTL, 28, 1>;
    using EPDIS = Field<DIEPCTL, 30, 1>;
    using EPENA = Field<DIEPCTL, 31, 1>;
  };
  struct DIEPINT : RegisterArray<base + 0x108, 0x20, 4> {
    using XFRC = Field<DIEPINT, 0, 1>;
    using EPDISD = Field<DIEPINT, 1, 1>;
    using INEPNE = Field<DIEPINT, 6, 1>;
  };
  struct DIEPTSIZ : RegisterArray<base + 0x110, 0x20, 4> {
    using XFRSIZ = Field<DIEPTSIZ, 0, 19>;
    using PKTCNT = Field<DIEPTSIZ, 19, 10>;
  };
  struct DTXFSTS : RegisterArray<base + 0x118, 0x20, 4> {
    using INEPTFSAV = Field<DTXFSTS, 0, 16>;
  };
  struct DOEPCTL : RegisterArray<base + 0x300, 0x20, 4> {
    using MPSIZ = Field<DOEPCTL, 0, 11>;
    using USBAEP = Field<DOEPCTL, 15, 1>;
    using NAKSTS = Field<DOEPCTL, 17, 1>;
    using EPTYP = Field<DOEPCTL, 18, 2>;
    using STALL = Field<DOEPCTL, 21, 1>;
    using CNAK = Field<DOEPCTL, 26, 1>;
    using SNAK = Field<DOEPCTL, 27, 1>;
    using SD0PID = Field<DOEPCTL, 28, 1>;
    using EPENA = Field<DOEPCTL, 31, 1>;
  };
  struct DOEPTSIZ : RegisterArray<base + 0x310, 0x20, 4> {
    using XFRSIZ = Field<DOEPTSIZ, 0, 19>;
    using PKTCNT = Field<DOEPTSIZ, 19, 10>;
    using STUPCNT = Field<DOEPTSIZ, 29, 2>;
  };
};

template <std::uint32_t base>
struct UsbPower {
  struct PCGCCTL : Register<base + 0x00> {};
};

/// Windows into the FIFO memory. A write adds a word to the transmit FIFO of the endpoint. A read from any window
/// removes a word from the receive FIFO.
template <std::uint32_t base>
struct UsbFifo {
  struct DFIFO : RegisterArray<base + 0x0000, 0x1000, 4> {};
};

}  // namespace inkwell::registers
