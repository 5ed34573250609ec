// Reads back what the pictures write: enough XML to check that it is well-formed and to find
// things.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinebase::test {

struct SvgElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;                 // Decoded.
  std::vector<std::string> groups;  // Classes of the <g> around it, outermost first,
  std::vector<std::size_t> inside;  // and their places among all elements.

  [[nodiscard]] double Number(const std::string& attribute) const {
    return std::stod(attributes.at(attribute));
  }
  [[nodiscard]] bool IsIn(std::string_view group) const {
    for (const std::string& around : groups) {
      if (around == group) return true;
    }
    return false;
  }
};

// Fails the test at the first place that is not well-formed (XML 1.0, Sect. 2.1).
class SvgReader {
 public:
  explicit SvgReader(std::string_view svg) : svg_(svg) {
    EXPECT_TRUE(Take("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"));
    while (at_ < svg_.size() && well_formed_) ReadNext();
    EXPECT_TRUE(well_formed_) << "at byte " << at_ << ": " << svg_.substr(at_, 80);
    EXPECT_TRUE(open_.empty()) << "never closed";
  }

  [[nodiscard]] const std::vector<SvgElement>& elements() const { return elements_; }

  [[nodiscard]] std::vector<SvgElement> Named(std::string_view name,
                                              std::string_view group = {}) const {
    std::vector<SvgElement> found;
    for (const SvgElement& element : elements_) {
      if (element.name == name && (group.empty() || element.IsIn(group))) found.push_back(element);
    }
    return found;
  }

  // What each group of this class holds, group by group.
  [[nodiscard]] std::vector<std::vector<SvgElement>> Groups(std::string_view name) const {
    std::vector<std::vector<SvgElement>> found;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const auto& attributes = elements_[i].attributes;
      if (elements_[i].name != "g" || attributes.at("class") != name) continue;
      found.emplace_back();
      for (const SvgElement& element : elements_) {
        for (const std::size_t around : element.inside) {
          if (around == i) found.back().push_back(element);
        }
      }
    }
    return found;
  }

  [[nodiscard]] std::vector<std::string> Texts() const {
    std::vector<std::string> texts;
    for (const SvgElement& element : Named("text")) texts.push_back(element.text);
    return texts;
  }

 private:
  bool Take(std::string_view expected) {
    if (!svg_.substr(at_).starts_with(expected)) return false;
    at_ += expected.size();
    return true;
  }

  std::string_view Until(std::string_view end) {
    const std::size_t begin = at_;
    const std::size_t found = svg_.find(end, at_);
    if (found == std::string_view::npos) {
      well_formed_ = false;
      return {};
    }
    at_ = found + end.size();
    return svg_.substr(begin, found - begin);
  }

  void ReadNext() {
    if (Take("</")) {
      const std::string_view name = Until(">");
      well_formed_ = well_formed_ && !open_.empty() && elements_[open_.back()].name == name;
      if (!well_formed_) return;
      open_.pop_back();
    } else if (Take("<")) {
      ReadTag();
    } else {
      const std::size_t begin = at_;
      while (at_ < svg_.size() && svg_[at_] != '<') ++at_;
      const std::string text = Decode(svg_.substr(begin, at_ - begin));
      if (!open_.empty()) {
        elements_[open_.back()].text += text;
      } else {
        well_formed_ = well_formed_ && text.find_first_not_of(" \n") == std::string::npos;
      }
    }
  }

  void ReadTag() {
    SvgElement element;
    for (const std::size_t open : open_) {
      if (elements_[open].name != "g") continue;
      element.groups.push_back(elements_[open].attributes["class"]);
      element.inside.push_back(open);
    }
    while (at_ < svg_.size() && std::string_view(" />").find(svg_[at_]) == std::string_view::npos) {
      element.name += svg_[at_++];
    }
    while (well_formed_ && Take(" ")) {
      const std::string name(Until("=\""));
      const std::string value = Decode(Until("\""));
      well_formed_ = well_formed_ && element.attributes.emplace(name, value).second;
    }
    const bool empty = Take("/>");
    well_formed_ = well_formed_ && !element.name.empty() && (empty || Take(">"));
    elements_.push_back(element);
    if (!empty) open_.push_back(elements_.size() - 1);
  }

  std::string Decode(std::string_view text) {
    static const std::map<std::string_view, char> kEntities = {
        {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}};
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] != '&') {
        well_formed_ = well_formed_ && text[i] != '<';
        decoded += text[i];
        continue;
      }
      const std::size_t end = text.find(';', i);
      const auto entity = kEntities.find(text.substr(i + 1, end - i - 1));
      if (end == std::string_view::npos || entity == kEntities.end()) {
        well_formed_ = false;
        return decoded;
      }
      decoded += entity->second;
      i = end;
    }
    return decoded;
  }

  std::string_view svg_;
  std::size_t at_ = 0;
  bool well_formed_ = true;
  std::vector<SvgElement> elements_;
  std::vector<std::size_t> open_;  // Indices into elements_.
};

}  // namespace kinebase::test
