#include "base/xml_text.hpp"

#include "base/errors.hpp"

#include <algorithm>
#include <iterator>

namespace snare::base {

namespace {

constexpr std::size_t deepest = 200;

constexpr std::pair<std::string_view, char> entities[] = {
    {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};

std::string resolved(std::string_view text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size();) {
    const auto known =
        std::ranges::find_if(entities, [&](const auto& e) { return text.substr(at).starts_with(e.first); });
    if (known == std::end(entities)) {
      plain += text[at++];
    } else {
      plain += known->second;
      at += known->first.size();
    }
  }
  return plain;
}

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

class Scanner {
 public:
  explicit Scanner(XmlText& xml) : xml_(xml), text_(xml.text) {}

  void run() {
    while (at_ < text_.size()) {
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("<!--")) {
        skip_to("-->");
      } else if (rest.starts_with("<![CDATA[")) {
        skip_to("]]>");
      } else if (rest.starts_with("<?")) {
        skip_to("?>");
      } else if (rest.starts_with("<!")) {
        fail("must have no document type");
      } else if (rest.starts_with("</")) {
        close();
      } else if (rest.starts_with("<")) {
        open();
      } else {
        ++at_;
      }
    }
    if (!open_.empty()) fail("must close <" + xml_.elements[open_.back()].name + ">");
    if (xml_.elements.empty()) fail("must be XML");
  }

 private:
  [[noreturn]] void fail(const std::string& requirement) const {
    const auto stop = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    const int line = 1 + static_cast<int>(std::count(text_.begin(), stop, '\n'));
    throw InputError({xml_.file, line, "", "", requirement});
  }

  void skip_to(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string_view::npos) fail("must end in \"" + std::string(end) + "\" what begins here");
    at_ = found + end.size();
  }

  [[nodiscard]] std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_]) && text_.substr(at_, 1).find_first_of("=/><\"'") != 0)
      ++at_;
    return text_.substr(begin, at_ - begin);
  }

  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }

  void close() {
    const std::size_t begin = at_;
    at_ += 2;
    const std::string_view name = word();
    skip_space();
    if (open_.empty() || xml_.elements[open_.back()].name != name || at_ >= text_.size() || text_[at_] != '>')
      fail("must close the element that was opened last");
    ++at_;
    xml_.elements[open_.back()].close_begin = begin;
    xml_.elements[open_.back()].end = at_;
    open_.pop_back();
  }

  void open() {
    XmlElement element;
    element.begin = at_;
    element.line =
        line_ + static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                            text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n'));
    line_ = element.line;
    counted_ = at_;
    element.parent = open_.empty() ? -1 : static_cast<int>(open_.back());
    if (open_.empty() && !xml_.elements.empty()) fail("must have one root element");
    if (open_.size() >= deepest) fail("must not nest its elements deeper");
    ++at_;
    element.name = word();
    if (element.name.empty()) fail("must have the name of an element after <");
    element.name_end = at_;
    for (skip_space(); at_ < text_.size() && text_[at_] != '>' && text_[at_] != '/'; skip_space())
      attribute(element);
    element.empty = at_ < text_.size() && text_[at_] == '/';
    if (element.empty) ++at_;
    if (at_ >= text_.size() || text_[at_] != '>') fail("must close the tag <" + element.name + " ...>");
    element.open_end = element.close_begin = element.end = ++at_;
    if (!element.empty) open_.push_back(xml_.elements.size());
    xml_.elements.push_back(std::move(element));
  }

  void attribute(XmlElement& element) {
    const std::string key(word());
    skip_space();
    if (key.empty() || at_ >= text_.size() || text_[at_] != '=')
      fail("must have attributes of the form name=\"value\"");
    ++at_;
    skip_space();
    const char quote = at_ < text_.size() ? text_[at_] : ' ';
    if (quote != '"' && quote != '\'') fail("must have the value of " + key + " in quotes");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("must close the quotes of " + key);
    element.attributes.emplace_back(key, resolved(text_.substr(at_ + 1, end - at_ - 1)));
    at_ = end + 1;
  }

  XmlText& xml_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t counted_ = 0;  // up to where lines are counted
  int line_ = 1;
  std::vector<std::size_t> open_;
};

}  // namespace

std::optional<std::string> XmlElement::attribute(std::string_view key) const {
  const auto found =
      std::ranges::find(attributes, key, [](const auto& a) { return std::string_view(a.first); });
  return found == attributes.end() ? std::nullopt : std::optional(found->second);
}

XmlText scan_xml(std::string file, std::string text) {
  XmlText xml{std::move(file), std::move(text), {}};
  Scanner(xml).run();
  return xml;
}

std::string xml_escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const auto known = std::ranges::find(entities, c, [](const auto& e) { return e.second; });
    if (known == std::end(entities)) {
      safe += c;
    } else {
      safe += known->first;
    }
  }
  return safe;
}

std::string with_insertions(std::string_view text,
                            std::vector<std::pair<std::size_t, std::string>> insertions) {
  std::ranges::stable_sort(insertions, {}, [](const auto& one) { return one.first; });
  std::string result;
  std::size_t done = 0;
  for (const auto& [offset, inserted] : insertions) {
    result += text.substr(done, offset - done);
    result += inserted;
    done = offset;
  }
  return result += text.substr(done);
}

}  // namespace snare::base
