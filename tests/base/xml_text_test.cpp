#include "base/xml_text.hpp"

#include "base/errors.hpp"

#include <gtest/gtest.h>

#include <string>

namespace snare::base {
namespace {

TEST(XmlText, ElementsKnowTheirPlacesInTheText) {
  const std::string text =
      "<?xml version='1.0'?>\n<!-- <b> -->\n<a x=\"1 &lt; 2\">\n  <b name='n'/><![CDATA[<c>]]></a>\n";
  const XmlText xml = scan_xml("f.xml", text);
  ASSERT_EQ(xml.elements.size(), 2U);
  const XmlElement &a = xml.elements[0], &b = xml.elements[1];
  EXPECT_EQ(a.attribute("x"), "1 < 2");
  EXPECT_EQ(a.attribute("y"), std::nullopt);
  EXPECT_EQ(b.attribute("name"), "n");
  EXPECT_EQ(a.parent, -1);
  EXPECT_EQ(b.parent, 0);
  EXPECT_EQ(b.line, 4);
  EXPECT_EQ(text.substr(b.begin, b.end - b.begin), "<b name='n'/>");
  EXPECT_EQ(text.substr(a.close_begin, a.end - a.close_begin), "</a>");
  EXPECT_TRUE(b.empty);
  EXPECT_EQ(with_insertions(text, {{a.close_begin, "<d/>"}, {b.begin, "!"}, {a.close_begin, "<e/>"}}),
            "<?xml version='1.0'?>\n<!-- <b> -->\n<a x=\"1 &lt; 2\">\n  !<b "
            "name='n'/><![CDATA[<c>]]><d/><e/></a>\n");
  EXPECT_EQ(xml_escaped("a<\"&'>"), "a&lt;&quot;&amp;&apos;&gt;");
}

TEST(XmlText, RefusesWithTheLineWhatIsNoXml) {
  for (const char* text : {"<a>\n<b></a>", "<a", "<a>", "", "<a x=1/>", "<a x=\"1/>", "<a/><b/>",
                           "<!DOCTYPE a><a/>", "<!-- a", "< a/>", "</a>", "<a x y='1'/>"}) {
    EXPECT_THROW(static_cast<void>(scan_xml("f.xml", text)), InputError) << text;
  }
  std::string deep;
  for (int i = 0; i < 300; ++i) deep += "<a>";
  EXPECT_THROW(static_cast<void>(scan_xml("f.xml", deep)), InputError);
  try {
    static_cast<void>(scan_xml("f.xml", "<a>\n<b></a>"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().line, 2);
    EXPECT_EQ(error.problems().front().file, "f.xml");
  }
}

}  // namespace
}  // namespace snare::base
