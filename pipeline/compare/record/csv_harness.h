/// Reads what RFC 4180 says a table is, for tests: knows nothing of the code that writes them.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace trapeze::testing {

using CsvRow = std::map<std::string, std::string>;

/// The records of a text: lines end with CR LF, cells in quotes may hold commas, line ends and doubled
/// quotes.
inline std::vector<std::vector<std::string>> csv_records(const std::string& text) {
    std::vector<std::vector<std::string>> records{{""}};
    bool quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
        std::string& cell = records.back().back();
        const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : '\0';
        if (quoted) {
            if (c != '"')
                cell += c;
            else if (next == '"')
                cell += c, ++i;
            else
                quoted = false;
        } else if (c == '"') {
            EXPECT_EQ(cell, "") << "a quote within a cell";
            quoted = true;
        } else if (c == ',') {
            records.back().emplace_back();
        } else if (c == '\r' && next == '\n') {
            ++i;
            if (i + 1 < text.size()) records.push_back({""});
        } else {
            EXPECT_NE(c, '\n') << "a line that ends without CR";
            cell += c;
        }
    }
    EXPECT_FALSE(quoted);
    EXPECT_TRUE(text.ends_with("\r\n"));
    return records;
}

/// The rows by the names in the first line; every row has as many cells.
inline std::vector<CsvRow> csv_rows(const std::string& text) {
    const auto records = csv_records(text);
    std::vector<CsvRow> rows;
    for (size_t r = 1; r < records.size(); ++r) {
        CsvRow& row = rows.emplace_back();
        EXPECT_EQ(records[r].size(), records[0].size()) << "row " << r;
        for (size_t c = 0; c < std::min(records[0].size(), records[r].size()); ++c)
            EXPECT_TRUE(row.emplace(records[0][c], records[r][c]).second) << records[0][c] << " comes twice";
    }
    return rows;
}

}  // namespace trapeze::testing
