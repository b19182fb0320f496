#include <cxxabi.h>
#include <elf.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include "boards/stm32f405/debugger/symbols.hpp"

#include <fmt/format.h>

namespace inkwell::virtual_board {
namespace {

template <class T>
std::optional<T> record_at(const std::vector<char>& file, std::size_t offset) {
  if (offset > file.size() || sizeof(T) > file.size() - offset) return std::nullopt;
  T record;
  std::memcpy(&record, file.data() + offset, sizeof record);
  return record;
}

std::string text_at(const std::vector<char>& file, std::size_t offset) {
  if (offset >= file.size()) return {};
  const auto begin = file.begin() + static_cast<std::ptrdiff_t>(offset);
  return {begin, std::find(begin, file.end(), '\0')};
}

std::string demangled(const std::string& name) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> text(abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status),
                                                    std::free);
  return status == 0 ? text.get() : name;
}

/// Symbol table of an ELF file. A damaged or missing file has no symbols.
class SymbolTable {
 public:
  explicit SymbolTable(const std::filesystem::path& elf) {
    std::ifstream stream(elf, std::ios::binary);
    file_.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    header_ = record_at<Elf32_Ehdr>(file_, 0);
  }

  /// Calls `see(symbol, name)` for each defined symbol.
  void for_each(const std::function<void(const Elf32_Sym&, const std::string&)>& see) const {
    for (unsigned i = 0; header_ && i < header_->e_shnum; ++i) {
      const auto table = section(i);
      if (!table || table->sh_type != SHT_SYMTAB) continue;
      const auto names = section(table->sh_link);
      if (!names) continue;
      for (std::size_t at = 0; at + sizeof(Elf32_Sym) <= table->sh_size; at += sizeof(Elf32_Sym)) {
        const auto symbol = record_at<Elf32_Sym>(file_, table->sh_offset + at);
        if (!symbol) break;
        if (symbol->st_shndx != SHN_UNDEF)
          see(*symbol, text_at(file_, std::size_t{names->sh_offset} + symbol->st_name));
      }
    }
  }

  /// Returns the bytes at the symbol up to the first zero byte.
  std::string text(const Elf32_Sym& symbol) const {
    const auto header = section(symbol.st_shndx);
    if (!header || header->sh_type != SHT_PROGBITS || symbol.st_value < header->sh_addr) return {};
    return text_at(file_, std::size_t{header->sh_offset} + (symbol.st_value - header->sh_addr));
  }

 private:
  std::optional<Elf32_Shdr> section(std::size_t number) const {
    return record_at<Elf32_Shdr>(file_, std::size_t{header_->e_shoff} + number * sizeof(Elf32_Shdr));
  }

  std::vector<char> file_;
  std::optional<Elf32_Ehdr> header_;
};

}  // namespace

std::string text_in_elf(const std::filesystem::path& elf, std::string_view name) {
  const SymbolTable table(elf);
  std::string text;
  table.for_each([&](const Elf32_Sym& symbol, const std::string& of_symbol) {
    if (of_symbol == name) text = table.text(symbol);
  });
  return text;
}

Symbols::Symbols(const std::filesystem::path& elf) {
  SymbolTable(elf).for_each([this](const Elf32_Sym& symbol, const std::string& name) {
    if (ELF32_ST_TYPE(symbol.st_info) == STT_FUNC) functions_.push_back({symbol.st_value & ~1u, symbol.st_size, name});
  });
  std::stable_sort(functions_.begin(), functions_.end(),
                   [](const Function& a, const Function& b) { return a.address < b.address; });
}

std::string Symbols::name(std::uint32_t address) const {
  auto after = std::upper_bound(functions_.begin(), functions_.end(), address,
                                [](std::uint32_t value, const Function& function) { return value < function.address; });
  if (after == functions_.begin()) return {};
  const Function& function = *std::prev(after);
  const std::uint32_t offset = address - function.address;
  // Assembler functions often have size 0. A function with size 0 extends to the next function.
  if (function.bytes != 0 ? offset >= function.bytes : after == functions_.end() && offset > 0) return {};
  return offset == 0 ? demangled(function.name) : fmt::format("{}+0x{:X}", demangled(function.name), offset);
}

}  // namespace inkwell::virtual_board
