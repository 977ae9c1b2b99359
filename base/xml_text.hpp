#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace snare::base {

/// One element of an XML text with its places in the text, so that a program can insert into the text and
/// keep the rest.
struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>>
      attributes;               ///< in the order of the text, entities resolved
  int line = 0;                 ///< of the opening tag, from 1
  int parent = -1;              ///< index in XmlText::elements; -1: the root
  std::size_t begin = 0;        ///< offset of the opening tag's '<'
  std::size_t name_end = 0;     ///< offset after the name in the opening tag
  std::size_t open_end = 0;     ///< offset after the opening tag's '>'
  std::size_t close_begin = 0;  ///< offset of the closing tag's '<'; open_end where the element closes itself
  std::size_t end = 0;          ///< offset after the element
  bool empty = false;           ///< closes itself: <name/>

  /// Value of an attribute, if the element has it.
  [[nodiscard]] std::optional<std::string> attribute(std::string_view key) const;
};

/// The elements of an XML text, parents before children, in the order of the text.
struct XmlText {
  std::string file;  ///< for messages
  std::string text;
  std::vector<XmlElement> elements;
};

/// Scans a text: comments, CDATA and processing instructions are passed over. Throws InputError, naming file
/// and line, for tags that do not match, attributes without a value in quotes, a document type, more than one
/// root, and elements more than 200 deep.
[[nodiscard]] XmlText scan_xml(std::string file, std::string text);

/// The text with its five special characters as entities, for an attribute in double quotes.
[[nodiscard]] std::string xml_escaped(std::string_view text);

/// The text with insertions, each before the character at its offset; those of one offset in their order.
[[nodiscard]] std::string with_insertions(std::string_view text,
                                          std::vector<std::pair<std::size_t, std::string>> insertions);

}  // namespace snare::base
