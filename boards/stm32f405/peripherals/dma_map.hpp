// Registers of a DMA controller (RM0090, DMA_LISR to DMA_SxFCR).
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

/// Flags of four streams: two streams in the lower half-word, two streams in the upper half-word.
template <unsigned lowest>
struct DmaFlags : Register {
  Field feif{"FEIF#", 0, 1, Access::r, {2, 6, lowest}}, feif_upper{"FEIF#", 16, 1, Access::r, {2, 6, lowest + 2}};
  Field dmeif{"DMEIF#", 2, 1, Access::r, {2, 6, lowest}}, dmeif_upper{"DMEIF#", 18, 1, Access::r, {2, 6, lowest + 2}};
  Field teif{"TEIF#", 3, 1, Access::r, {2, 6, lowest}}, teif_upper{"TEIF#", 19, 1, Access::r, {2, 6, lowest + 2}};
  Field htif{"HTIF#", 4, 1, Access::r, {2, 6, lowest}}, htif_upper{"HTIF#", 20, 1, Access::r, {2, 6, lowest + 2}};
  Field tcif{"TCIF#", 5, 1, Access::r, {2, 6, lowest}}, tcif_upper{"TCIF#", 21, 1, Access::r, {2, 6, lowest + 2}};
};

template <unsigned lowest>
struct DmaFlagClear : Register {
  Field cfeif{"CFEIF#", 0, 1, Access::w, {2, 6, lowest}}, cfeif_upper{"CFEIF#", 16, 1, Access::w, {2, 6, lowest + 2}};
  Field cdmeif{"CDMEIF#", 2, 1, Access::w, {2, 6, lowest}},
      cdmeif_upper{"CDMEIF#", 18, 1, Access::w, {2, 6, lowest + 2}};
  Field cteif{"CTEIF#", 3, 1, Access::w, {2, 6, lowest}}, cteif_upper{"CTEIF#", 19, 1, Access::w, {2, 6, lowest + 2}};
  Field chtif{"CHTIF#", 4, 1, Access::w, {2, 6, lowest}}, chtif_upper{"CHTIF#", 20, 1, Access::w, {2, 6, lowest + 2}};
  Field ctcif{"CTCIF#", 5, 1, Access::w, {2, 6, lowest}}, ctcif_upper{"CTCIF#", 21, 1, Access::w, {2, 6, lowest + 2}};
};

struct DmaRegisters {
  DmaFlags<0> lisr{{"LISR", 0x00}};
  DmaFlags<4> hisr{{"HISR", 0x04}};
  DmaFlagClear<0> lifcr{{"LIFCR", 0x08}};
  DmaFlagClear<4> hifcr{{"HIFCR", 0x0C}};
  struct : Register {
    Field en{"EN", 0}, dmeie{"DMEIE", 1}, teie{"TEIE", 2}, htie{"HTIE", 3}, tcie{"TCIE", 4}, pfctrl{"PFCTRL", 5},
        dir{"DIR", 6, 2}, circ{"CIRC", 8}, pinc{"PINC", 9}, minc{"MINC", 10}, psize{"PSIZE", 11, 2},
        msize{"MSIZE", 13, 2}, pincos{"PINCOS", 15}, pl{"PL", 16, 2}, dbm{"DBM", 18}, ct{"CT", 19},
        pburst{"PBURST", 21, 2}, mburst{"MBURST", 23, 2}, chsel{"CHSEL", 25, 3};
  } cr{{"S#CR", 0x10, 0, {8, 0x18, 0}}};
  struct : Register {
    Field ndt{"NDT", 0, 16};
  } ndtr{{"S#NDTR", 0x14, 0, {8, 0x18, 0}}};
  struct : Register {
    Field pa{"PA", 0, 32};
  } par{{"S#PAR", 0x18, 0, {8, 0x18, 0}}};
  struct : Register {
    Field m0a{"M0A", 0, 32};
  } m0ar{{"S#M0AR", 0x1C, 0, {8, 0x18, 0}}};
  struct : Register {
    Field m1a{"M1A", 0, 32};
  } m1ar{{"S#M1AR", 0x20, 0, {8, 0x18, 0}}};
  struct : Register {
    Field fth{"FTH", 0, 2}, dmdis{"DMDIS", 2}, fs{"FS", 3, 3, Access::r}, feie{"FEIE", 7};
  } fcr{{"S#FCR", 0x24, 0x21, {8, 0x18, 0}}};
};
inline constexpr DmaRegisters dma;

/// SxCR.DIR
enum DmaDirection : std::uint32_t { peripheral_to_memory = 0, memory_to_peripheral = 1, memory_to_memory = 2 };

}  // namespace inkwell::virtual_board
