/// What code and documents refer to is there: pages of docs/decisions, files and headings that links name.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;

const fs::path kRoot = TRAPEZE_SOURCE_DIR;
const fs::path kDecisions = kRoot / "docs" / "decisions";

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Where what the project's people write lies: builds and what git keeps do not count.
const std::set<std::string> kFolders = {"accel",  "cmake",  "composite", "core",  "docs",      "pipeline",
                                        "sample", "scenes", "shade",     "tests", "tessellate"};
const std::set<std::string> kEndings = {".h", ".cpp", ".c", ".sl", ".md", ".py", ".txt", ".cmake", ".sh", ""};

bool holds_text(const fs::path& path) {
    return kEndings.count(path.extension().string()) && path.string().find("/seeds/") == std::string::npos;
}

/// Files of the project with words in them, and those at its root.
std::vector<fs::path> written_files() {
    std::vector<fs::path> files;
    const auto take = [&files](const fs::directory_entry& entry) {
        if (entry.is_regular_file() && holds_text(entry.path())) files.push_back(entry.path());
    };
    for (const auto& entry : fs::directory_iterator(kRoot)) take(entry);
    for (const std::string& folder : kFolders)
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) take(entry);
    return files;
}

std::vector<fs::path> pages() {
    std::vector<fs::path> found;
    for (const fs::path& file : written_files())
        if (file.extension() == ".md") found.push_back(file);
    return found;
}

/// Calls visit(match) for each match of an expression in a text.
template <class Visit>
void for_each_match(const std::string& text, const std::regex& expression, Visit&& visit) {
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) visit(*at);
}

std::string place_of(const fs::path& file, const std::string& text, std::ptrdiff_t position) {
    const auto line = std::count(text.begin(), text.begin() + position, '\n') + 1;
    return fs::relative(file, kRoot).string() + ":" + std::to_string(line);
}

/// Number, as four digits -> file name, of the pages of decisions.
std::map<std::string, std::string> decision_pages() {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::directory_iterator(kDecisions)) {
        const std::string name = entry.path().filename();
        if (name == "README.md") continue;
        EXPECT_TRUE(std::regex_match(name, std::regex(R"(\d{4}-[a-z0-9-]+\.md)"))) << name;
        EXPECT_TRUE(found.emplace(name.substr(0, 4), name).second) << "two decisions " << name.substr(0, 4);
    }
    return found;
}

TEST(Decisions, AreNumberedFromOneInTheirNamesAndTitles) {
    int number = 0;
    for (const auto& [digits, name] : decision_pages()) {
        EXPECT_EQ(std::stoi(digits), ++number) << name;
        EXPECT_TRUE(read_text(kDecisions / name).starts_with("# " + std::to_string(number) + ". ")) << name;
    }
    EXPECT_GE(number, 27);
}

TEST(Decisions, AreListed) {
    const std::string index = read_text(kDecisions / "README.md");
    for (const auto& [digits, name] : decision_pages())
        EXPECT_NE(index.find("[" + digits + "](" + name + ")"), std::string::npos) << name;
}

/// By number they are cited as "decision" and four digits, by file with the whole name.
TEST(Decisions, AreThereWhereTheyAreCited) {
    static const std::regex by_number(R"(\bdecisions?[\s/*]+([0-9]+)\b)", std::regex::icase);
    static const std::regex by_file(R"(decisions/([0-9][^\s)\]`'",;:]*))");
    const std::map<std::string, std::string> known = decision_pages();
    std::set<std::string> names;
    for (const auto& [digits, name] : known) names.insert(name);
    std::vector<std::string> lost;
    int citations = 0;
    for (const fs::path& file : written_files()) {
        const std::string text = read_text(file);
        const auto check = [&](const std::set<std::string>& good, const std::smatch& match) {
            ++citations;
            if (!good.count(match[1]))
                lost.push_back(place_of(file, text, match.position()) + ": " + match.str());
        };
        std::set<std::string> numbers;
        for (const auto& [digits, name] : known) numbers.insert(digits);
        for_each_match(text, by_number, [&](const std::smatch& match) { check(numbers, match); });
        for_each_match(text, by_file, [&](const std::smatch& match) { check(names, match); });
    }
    EXPECT_THAT(lost, IsEmpty()) << "not cited as \"decision 0006\" or by the page's whole name";
    EXPECT_GT(citations, 30) << "the test reads no files";
}

/// Paths from the root in the text of decisions, which say where the code is.
TEST(Decisions, NameFilesThatAreThere) {
    static const std::regex path(R"((?:^|[^\w/.-])((\w+)/[\w./-]*\w)(?![\w*]))");
    std::vector<std::string> lost;
    int paths = 0;
    for (const auto& [digits, name] : decision_pages()) {
        const std::string text = read_text(kDecisions / name);
        for_each_match(text, path, [&, &page = name](const std::smatch& match) {
            if (!kFolders.count(match[2])) return;
            ++paths;
            if (!fs::exists(kRoot / match[1].str()))
                lost.push_back(place_of(kDecisions / page, text, match.position()) + ": " + match.str(1));
        });
    }
    EXPECT_THAT(lost, IsEmpty());
    EXPECT_GT(paths, 50) << "the test reads no pages";
}

/// A page's text with what is code made blank, so that positions stay.
std::string without_code(std::string text) {
    static const std::regex code("```[^]*?```|`[^`\n]*`");
    std::string blank = text;
    for_each_match(text, code, [&blank](const std::smatch& match) {
        for (auto i = match.position(); i < match.position() + match.length(); ++i)
            if (blank[static_cast<size_t>(i)] != '\n') blank[static_cast<size_t>(i)] = ' ';
    });
    return blank;
}

/// What "#..." after a page's name may be, by the rule that forges make them of headings.
std::set<std::string> anchors_of(const std::string& page) {
    static const std::regex heading("(?:^|\n)#+ ([^\n]*)");
    std::set<std::string> anchors;
    for_each_match(page, heading, [&anchors](const std::smatch& match) {
        std::string anchor;
        for (const char c : match[1].str()) {
            const auto letter = static_cast<unsigned char>(c);
            if (std::isalnum(letter) || c == '-' || c == '_' || letter >= 128)
                anchor += static_cast<char>(std::tolower(letter));
            else if (c == ' ')
                anchor += '-';
        }
        anchors.insert(anchor);
    });
    return anchors;
}

TEST(Links, LeadToFilesAndHeadingsThatAreThere) {
    static const std::regex link(R"(\]\(([^)\s]+)\))");
    std::vector<std::string> lost;
    int links = 0;
    for (const fs::path& file : pages()) {
        const std::string text = without_code(read_text(file));
        for_each_match(text, link, [&](const std::smatch& match) {
            const std::string to = match[1];
            if (to.find("://") != std::string::npos || to.starts_with("mailto:")) return;
            ++links;
            const size_t hash = std::min(to.find('#'), to.size());
            const fs::path target = hash == 0 ? file : file.parent_path() / to.substr(0, hash);
            const bool is_there =
                fs::exists(target) &&
                (hash == to.size() || anchors_of(read_text(target)).count(to.substr(hash + 1)));
            if (!is_there) lost.push_back(place_of(file, text, match.position()) + ": " + to);
        });
    }
    EXPECT_THAT(lost, IsEmpty());
    EXPECT_GT(links, 30) << "the test reads no pages";
}

}  // namespace
