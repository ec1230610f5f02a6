#include "pipeline/compare/record/figures_csv.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "pipeline/compare/record/csv_harness.h"

namespace trapeze {
namespace {

using json = nlohmann::ordered_json;
using testing::csv_records;
using testing::csv_rows;

TEST(FiguresCsv, QuotesWhatHasToBeQuoted) {
    const std::vector<std::string> names = {"a,b", "say \"x\"", "two\r\nlines", "line\nfeed", "plain",
                                            "",    " "};
    json figures = json::array();
    for (const std::string& name : names) figures.push_back({{"name", name}, {"second, column", 1}});
    const auto records = csv_records(figures_csv(json::object(), figures));
    ASSERT_EQ(records.size(), names.size() + 1);
    EXPECT_EQ(records[0], (std::vector<std::string>{"name", "second, column"}));
    for (size_t i = 0; i < names.size(); ++i) EXPECT_EQ(records[i + 1][0], names[i]);
}

TEST(FiguresCsv, RoundsAreRowsAndNumbersAreTheJsons) {
    const double third = 1.0 / 3;
    const json figures = json::array({{{"method", "a"},
                                       {"rmse", third},
                                       {"tests", uint64_t{12345678901234567}},
                                       {"seconds_by_round", {0.1, 1e-9, 3.0}}},
                                      {{"method", "b"}, {"held", true}}});
    const auto rows = csv_rows(figures_csv({{"scene", "s.rib"}}, figures));
    ASSERT_EQ(rows.size(), 4u);
    for (size_t r = 0; r < 3; ++r) {
        EXPECT_EQ(rows[r].at("round"), std::to_string(r + 1));
        EXPECT_EQ(std::stod(rows[r].at("rmse")), third);
        EXPECT_EQ(rows[r].at("tests"), "12345678901234567");
        EXPECT_EQ(std::stod(rows[r].at("seconds_by_round")), figures[0]["seconds_by_round"][r].get<double>());
    }
    EXPECT_EQ(rows[3].at("round"), "");
    EXPECT_EQ(rows[3].at("rmse"), "");
    EXPECT_EQ(rows[3].at("held"), "true");
    for (const auto& row : rows) EXPECT_EQ(row.at("scene"), "s.rib");
}

TEST(FiguresCsv, WhatIsNoNumberIsAnEmptyCell) {
    const json figures = json::array({{{"a", std::numeric_limits<double>::quiet_NaN()}, {"b", nullptr}}});
    const auto rows = csv_rows(figures_csv(json::object(), figures));
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].at("a"), "");
    EXPECT_EQ(rows[0].at("b"), "");
}

TEST(FiguresCsv, BytesThatAreNoUtf8AreReplaced) {
    const auto records = csv_records(figures_csv(json::object(), json::array({{{"name", "a\xff,b"}}})));
    EXPECT_EQ(records[1][0], "a\xEF\xBF\xBD,b");
}

}  // namespace
}  // namespace trapeze
