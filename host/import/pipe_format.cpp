#include "host/import/pipe_format.hpp"

#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "host/import/error.hpp"

namespace inkwell::importer {
namespace {

enum class MessageKind : std::uint32_t { refusal = 0x52'4B'4E'49, content = 0x43'4B'4E'49 };

constexpr std::uint32_t no_unit = 0xFFFFFFFF;

/// Follows the kind. After it follow the texts, the vertices and the faces.
struct ContentHeader {
  std::uint64_t vertices;
  std::uint64_t faces;
  std::uint32_t unit;
  std::uint32_t is_unit_doubtful;
  std::uint32_t remarks;
  std::uint32_t reserved;
};

class MessageWriter {
 public:
  explicit MessageWriter(MessageKind kind) { add(kind); }

  template <class Value>
  void add(const Value& value) {
    add_array(std::span(&value, 1));
  }
  template <class Value>
  void add_array(std::span<Value> values) {
    const auto bytes = std::as_bytes(values);
    message_.insert(message_.end(), bytes.begin(), bytes.end());
  }
  void add_text(std::string_view text) {
    add(static_cast<std::uint32_t>(text.size()));
    add_array(std::span(text));
  }
  std::vector<std::byte> take() { return std::move(message_); }

 private:
  std::vector<std::byte> message_;
};

class MessageReader {
 public:
  MessageReader(std::span<const std::byte> message, const std::string& name) : rest_(message), name_(name) {}

  template <class Value>
  Value next() {
    Value value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() {
    const auto characters = bytes(next<std::uint32_t>());
    return {reinterpret_cast<const char*>(characters.data()), characters.size()};
  }
  template <class Value>
  std::vector<Value> array(std::uint64_t count) {
    if (count > rest_.size() / sizeof(Value)) fail();
    const auto raw = bytes(static_cast<std::size_t>(count) * sizeof(Value));
    std::vector<Value> values(static_cast<std::size_t>(count));
    if (!raw.empty()) std::memcpy(values.data(), raw.data(), raw.size());
    return values;
  }
  void expect_end() {
    if (!rest_.empty()) fail();
  }
  [[noreturn]] void fail() {
    throw Error(
        fmt::format("The reader of {} stopped in the middle, so the file is damaged or too large. Export the "
                    "object as STL.",
                    name_));
  }

 private:
  std::span<const std::byte> bytes(std::size_t count) {
    if (count > rest_.size()) fail();
    const auto found = rest_.first(count);
    rest_ = rest_.subspan(count);
    return found;
  }

  std::span<const std::byte> rest_;
  const std::string& name_;
};

}  // namespace

std::vector<std::byte> encode(const FileContent& content) {
  MessageWriter writer(MessageKind::content);
  writer.add(ContentHeader{content.vertices.size(), content.faces.size(),
                           content.unit ? static_cast<std::uint32_t>(*content.unit) : no_unit,
                           content.is_unit_doubtful ? 1u : 0u, static_cast<std::uint32_t>(content.remarks.size()), 0});
  for (const std::string& remark : content.remarks) writer.add_text(remark);
  writer.add_array(std::span(content.vertices));
  writer.add_array(std::span(content.faces));
  return writer.take();
}

std::vector<std::byte> encode_refusal(std::string_view sentence) {
  MessageWriter writer(MessageKind::refusal);
  writer.add_text(sentence);
  return writer.take();
}

FileContent decode(std::span<const std::byte> message, const std::string& name) {
  MessageReader reader(message, name);
  switch (reader.next<MessageKind>()) {
    case MessageKind::refusal: throw Error(reader.text());
    case MessageKind::content: break;
    default: reader.fail();
  }
  const auto header = reader.next<ContentHeader>();
  FileContent content;
  if (header.unit != no_unit) {
    if (header.unit >= all_units.size()) reader.fail();
    content.unit = static_cast<Unit>(header.unit);
  }
  content.is_unit_doubtful = header.is_unit_doubtful != 0;
  // Each remark needs at least the four bytes of its length, so the loop ends with the message.
  for (std::uint32_t i = 0; i < header.remarks; ++i) content.remarks.push_back(protocol::plain_text(reader.text()));
  content.vertices = reader.array<glm::dvec3>(header.vertices);
  content.faces = reader.array<geometry::Face>(header.faces);
  reader.expect_end();
  return content;
}

}  // namespace inkwell::importer
