#include "analysis/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/error.h"
#include "core/image_file.h"
#include "tests/own_folder.h"

namespace retrolux {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const char* const kNasty = "</script><script>alert('1')</script> & \"q\" {{js}} <!--";

// The content as a browser would read it: up to the first end of a script element.
json ContentOf(const std::string& html) {
  const std::string begin = "id=\"content\">";
  const size_t from = html.find(begin) + begin.size();
  return json::parse(html.substr(from, html.find("</script", from) - from));
}

size_t Count(const std::string& text, const std::string& what) {
  size_t count = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

Report SmallReport() {
  Report report("Title", "Subtitle");
  report.Heading("Heading");
  report.Table("Table", {"a", "b"}, {{"1", "x,y"}, {"2", "\"z\""}});
  report.Picture("Picture", EncodeRgbPng(2, 1, {0, 0, 0, 255, 255, 255}));
  return report;
}

TEST(Report, TextNeverBecomesMarkup) {
  Report report(kNasty, kNasty);
  report.Heading(kNasty);
  report.Paragraph(kNasty);
  report.KeyFigures({{kNasty, kNasty, kNasty, kNasty}});
  report.Table(kNasty, {kNasty}, {{kNasty}});
  const std::string html = report.Html();
  EXPECT_THAT(html, Not(HasSubstr("alert('1')</script>")));
  EXPECT_THAT(html, HasSubstr("<title>&lt;/script&gt;&lt;script&gt;alert('1')&lt;/script&gt; &amp; "
                              "&quot;q&quot; {{js}} &lt;!--</title>"));
  const json content = ContentOf(html);
  EXPECT_EQ(content["title"], kNasty);
  EXPECT_EQ(content["blocks"][0]["text"], kNasty);
  EXPECT_EQ(content["blocks"][3]["rows"][0][0], kNasty);
  // The page's own: content, plot library, program.
  EXPECT_EQ(Count(html, "<script"), 3u);
  EXPECT_EQ(Count(html, "</script"), 3u);
}

TEST(Report, SameContentSameBytes) {
  EXPECT_EQ(SmallReport().Html(), SmallReport().Html());
}

TEST(Report, BytesThatAreNotUtf8DoNoHarm) {
  Report report("caf\xe9", "");
  EXPECT_EQ(ContentOf(report.Html())["title"], "caf\xef\xbf\xbd");
}

TEST(Report, AsksNothingOfTheNetwork) {
  std::string html = SmallReport().Html();  // no plot, so that all of it is ours
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  const std::string name_space = "'http://www.w3.org/2000/svg'";  // a name that nobody loads
  html.replace(html.find(name_space), name_space.size(), "");
  EXPECT_THAT(html, Not(HasSubstr("http://")));
  EXPECT_THAT(html, Not(HasSubstr("https://")));
  for (const char* loader : {"src=\"", "@import", "url(", "fetch(", "<link rel=\"stylesheet"}) {
    EXPECT_THAT(html, Not(HasSubstr(loader)));
  }
}

TEST(Report, CarriesAttachments) {
  const std::string text = "a,b\n1,\"</script> \\ \u00e9 \u2028 <!-- <script>\"\n\t\x01";
  Report report("t", "");
  report.Attachment("hits.csv", text);
  const json block = ContentOf(report.Html())["blocks"][0];
  EXPECT_EQ(block["file_name"], "hits.csv");
  EXPECT_EQ(block["text"], text);
}

// RFC 4648, section 10, after the eight bytes of the signature and one more, three groups.
TEST(Report, CarriesPicturesAsBase64) {
  const std::string signature = "\x89PNG\r\n\x1a\n\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}};
  for (const auto& [bytes, base64] : cases) {
    Report report("t", "");
    report.Picture("p", signature + bytes);
    const json block = ContentOf(report.Html())["blocks"][0];
    EXPECT_EQ(block["items"][0]["png"], "iVBORw0KGgoK" + base64);
  }
  EXPECT_THROW(Report("t", "").Picture("p", "GIF89a"), std::logic_error);
}

TEST(Report, UnrollsOvalMapsFromTheLeftOverTheTop) {
  const OvalGrid grid{2, 3, 140.0, 100.0};
  const OvalMap map{"m", "", {0, 1, 2, 3, 4, 5}, {6, 7, 8, 9, 10, 11}};
  const std::vector<OvalCategory> categories(12, {"c", "#000"});
  Report report("t", "");
  report.OvalMaps("maps", categories, {map}, grid);
  const json block = ContentOf(report.Html())["blocks"][0];
  EXPECT_EQ(block["maps"][0]["values"], json({{2, 1, 0, 6, 7, 8}, {5, 4, 3, 9, 10, 11}}));
  EXPECT_THROW(report.OvalMaps("few", HitMissCategories(), {map}, grid), std::logic_error);
  EXPECT_THROW(report.OvalMaps("size", categories, {map}), std::logic_error);
}

TEST(Report, CategoriesAreDistinct) {
  for (const auto& categories :
       {CountCategories(6), CountCategories(1), NamedCategories({"a", "b", "c", "d", "e"})}) {
    for (size_t i = 0; i < categories.size(); ++i) {
      for (size_t k = 0; k < i; ++k) EXPECT_NE(categories[i].colour, categories[k].colour);
    }
  }
  EXPECT_EQ(CountCategories(6).size(), 7u);
  EXPECT_EQ(CountCategories(6).back().colour, "#440154");
}

// A data folder that has the page but not the library.
class ReportWithoutLibrary : public testing::Test {
 protected:
  void SetUp() override {
    namespace fs = std::filesystem;
    root_ = OwnFolder() / "report_without_library";
    const fs::path page = root_ / "analysis/report";
    fs::create_directories(page / "node_modules/plotly.js-dist-min");
    for (const char* name :
         {"page.html", "page.css", "oval.js", "plot.js", "viewer.js", "page.js"}) {
      WriteTextFile(page / name, ReadTextFile(DataPath(fs::path("analysis/report") / name)));
    }
    library_ = page / "node_modules/plotly.js-dist-min/plotly.min.js";
    ::setenv("RETROLUX_DATA", root_.c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("RETROLUX_DATA");
    std::filesystem::remove_all(root_);
  }
  std::filesystem::path root_, library_;
};

TEST_F(ReportWithoutLibrary, IsOnlyNeededByPlots) {
  WriteTextFile(library_, "var Plotly = 'the library';");
  Report report = SmallReport();
  EXPECT_THAT(report.Html(), Not(HasSubstr("the library")));
  report.Plot("p", {{{"y", {1, 2}}}});
  EXPECT_THAT(report.Html(), HasSubstr("<script>var Plotly = 'the library';</script>"));
}

TEST_F(ReportWithoutLibrary, SaysWhatToRun) {
  std::filesystem::create_directory(library_);  // found before one that is installed, and no file
  Report report("t", "");
  report.Plot("p", json::array());
  try {
    report.Html();
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("scripts/setup.sh"));
    EXPECT_THAT(error.what(), HasSubstr("plotly.min.js"));
  }
}

TEST(Report, WritesTheWholeFileOrNone) {
  const std::filesystem::path file = OwnFolder() / "report.html";
  SmallReport().Write(file);
  EXPECT_EQ(ReadTextFile(file), SmallReport().Html());
  std::filesystem::remove(file);
  EXPECT_THROW(SmallReport().Write("/nowhere/report.html"), InputError);
}

}  // namespace
}  // namespace retrolux
