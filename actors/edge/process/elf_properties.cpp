#include "actors/edge/process/elf_properties.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <elf.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>

namespace roscell {

namespace {

/// The program headers follow the first header in what linkers make.
constexpr size_t bytes_read = 4096;

/// A structure that lies at `offset`; none where it does not end in `bytes`.
template <class T>
std::optional<T> read_at(std::string_view bytes, uint64_t offset) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T))
    return std::nullopt;
  T result;
  std::memcpy(&result, bytes.data() + offset, sizeof(T));
  return result;
}

/// Empty for another machine.
std::string architecture_for(uint16_t machine) {
  switch (machine) {
  case EM_X86_64:
    return "amd64";
  case EM_AARCH64:
    return "arm64";
  case EM_ARM:
    return "arm";
  case EM_386:
    return "386";
  default:
    return {};
  }
}

/// The text at a place in the file, up to its zero byte.
std::string text_at(std::string_view bytes, uint64_t offset, uint64_t size) {
  if (offset > bytes.size())
    return {};
  const auto text = bytes.substr(offset, size);
  return std::string{text.substr(0, text.find('\0'))};
}

template <class Header, class ProgramHeader>
void read_parts(std::string_view bytes, elf_properties& result) {
  const auto header = read_at<Header>(bytes, 0);
  if (!header || header->e_phnum == 0)
    return;
  bool is_static = true;
  for (uint64_t i = 0; i < header->e_phnum; ++i) {
    const auto part = read_at<ProgramHeader>(
        bytes, header->e_phoff + i * sizeof(ProgramHeader));
    if (!part)
      return;
    is_static = is_static && part->p_type != PT_DYNAMIC;
    if (part->p_type == PT_INTERP)
      result.interpreter = text_at(bytes, part->p_offset, part->p_filesz);
  }
  result.is_static = is_static;
}

} // namespace

std::optional<elf_properties> parse_elf(std::string_view bytes) {
  constexpr auto own_order =
      __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? ELFDATA2LSB : ELFDATA2MSB;
  if (bytes.substr(0, SELFMAG) != ELFMAG)
    return std::nullopt;
  elf_properties result;
  if (bytes.size() < EI_NIDENT || bytes[EI_DATA] != own_order)
    return result;
  // The first fields are the same for 32 and 64 bits.
  const auto machine =
      read_at<uint16_t>(bytes, offsetof(Elf32_Ehdr, e_machine));
  result.architecture = machine ? architecture_for(*machine) : std::string{};
  if (bytes[EI_CLASS] == ELFCLASS64)
    read_parts<Elf64_Ehdr, Elf64_Phdr>(bytes, result);
  else
    read_parts<Elf32_Ehdr, Elf32_Phdr>(bytes, result);
  return result;
}

std::optional<elf_properties> read_elf(const std::filesystem::path& file) {
  const unique_fd open_file{
      ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  std::array<char, bytes_read> bytes{};
  const auto count =
      open_file ? ::read(open_file.get(), bytes.data(), bytes.size()) : -1;
  if (count < 0)
    return std::nullopt;
  return parse_elf({bytes.data(), static_cast<size_t>(count)});
}

} // namespace roscell
