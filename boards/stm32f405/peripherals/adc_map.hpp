// Registers of one converter and the common registers (RM0090, ADC_SR to ADC_CDR).
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

struct AdcRegisters {
  struct : Register {
    Field awd{"AWD", 0, 1, Access::rc_w0}, eoc{"EOC", 1, 1, Access::rc_w0}, jeoc{"JEOC", 2, 1, Access::rc_w0},
        jstrt{"JSTRT", 3, 1, Access::rc_w0}, strt{"STRT", 4, 1, Access::rc_w0}, ovr{"OVR", 5, 1, Access::rc_w0};
  } sr{{"SR", 0x00}};
  struct : Register {
    Field awdch{"AWDCH", 0, 5}, eocie{"EOCIE", 5}, awdie{"AWDIE", 6}, jeocie{"JEOCIE", 7}, scan{"SCAN", 8},
        awdsgl{"AWDSGL", 9}, jauto{"JAUTO", 10}, discen{"DISCEN", 11}, jdiscen{"JDISCEN", 12},
        discnum{"DISCNUM", 13, 3}, jawden{"JAWDEN", 22}, awden{"AWDEN", 23}, res{"RES", 24, 2}, ovrie{"OVRIE", 26};
  } cr1{{"CR1", 0x04}};
  struct : Register {
    Field adon{"ADON", 0}, cont{"CONT", 1}, dma{"DMA", 8}, dds{"DDS", 9}, eocs{"EOCS", 10}, align{"ALIGN", 11},
        jextsel{"JEXTSEL", 16, 4}, jexten{"JEXTEN", 20, 2}, jswstart{"JSWSTART", 22, 1, Access::rs},
        extsel{"EXTSEL", 24, 4}, exten{"EXTEN", 28, 2}, swstart{"SWSTART", 30, 1, Access::rs};
  } cr2{{"CR2", 0x08}};
  struct : Register {
    Field smp{"SMP#", 0, 3, Access::rw, {9, 3, 10}};
  } smpr1{{"SMPR1", 0x0C}};
  struct : Register {
    Field smp{"SMP#", 0, 3, Access::rw, {10, 3, 0}};
  } smpr2{{"SMPR2", 0x10}};
  struct : Register {
    Field joffset{"JOFFSET#", 0, 12};
  } jofr{{"JOFR#", 0x14, 0, {4, 4, 1}}};
  struct : Register {
    Field ht{"HT", 0, 12};
  } htr{{"HTR", 0x24, 0xFFF}};
  struct : Register {
    Field lt{"LT", 0, 12};
  } ltr{{"LTR", 0x28}};
  struct : Register {
    Field sq{"SQ#", 0, 5, Access::rw, {4, 5, 13}}, l{"L", 20, 4};
  } sqr1{{"SQR1", 0x2C}};
  struct : Register {
    Field sq{"SQ#", 0, 5, Access::rw, {6, 5, 7}};
  } sqr2{{"SQR2", 0x30}};
  struct : Register {
    Field sq{"SQ#", 0, 5, Access::rw, {6, 5, 1}};
  } sqr3{{"SQR3", 0x34}};
  struct : Register {
    Field jsq{"JSQ#", 0, 5, Access::rw, {4, 5, 1}}, jl{"JL", 20, 2};
  } jsqr{{"JSQR", 0x38}};
  struct : Register {
    Field jdata{"JDATA", 0, 16, Access::r};
  } jdr{{"JDR#", 0x3C, 0, {4, 4, 1}}};
  struct : Register {
    Field data{"DATA", 0, 16, Access::r};
  } dr{{"DR", 0x4C}};
};
inline constexpr AdcRegisters adc;

struct AdcCommonRegisters {
  struct : Register {
    Field awd{"AWD#", 0, 1, Access::r, {3, 8, 1}}, eoc{"EOC#", 1, 1, Access::r, {3, 8, 1}},
        jeoc{"JEOC#", 2, 1, Access::r, {3, 8, 1}}, jstrt{"JSTRT#", 3, 1, Access::r, {3, 8, 1}},
        strt{"STRT#", 4, 1, Access::r, {3, 8, 1}}, ovr{"OVR#", 5, 1, Access::r, {3, 8, 1}};
  } csr{{"CSR", 0x00}};
  struct : Register {
    Field multi{"MULTI", 0, 5}, delay{"DELAY", 8, 4}, dds{"DDS", 13}, dma{"DMA", 14, 2}, adcpre{"ADCPRE", 16, 2},
        vbate{"VBATE", 22}, tsvrefe{"TSVREFE", 23};
  } ccr{{"CCR", 0x04}};
  struct : Register {
    Field data{"DATA#", 0, 16, Access::r, {2, 16, 1}};
  } cdr{{"CDR", 0x08}};
};
inline constexpr AdcCommonRegisters adc_common;

/// Lower bits of ADC_CCR.MULTI. The highest bit of MULTI adds the third converter.
enum class MultiMode : std::uint8_t {
  independent = 0,
  regular_and_injected = 1,   ///< both groups simultaneous
  regular_and_alternate = 2,  ///< regular group simultaneous, injected group by alternate triggers
  injected = 5,
  regular = 6,
  interleaved = 7,
  alternate = 9,
};
inline constexpr std::uint32_t multi_triple = 0x10;

}  // namespace inkwell::virtual_board
