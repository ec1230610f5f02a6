#include "pipeline/rib/write/rib_writer.h"

#include <zlib.h>

#include <bit>
#include <cmath>
#include <random>

#include "pipeline/rib/reading_harness.h"
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/write/gzip_writer.h"

namespace trapeze::testing {
namespace {

std::string written(rib::RibEncoding encoding, const std::function<void(rib::RibWriter&)>& write) {
    std::string text;
    rib::RibWriter writer(encoding, [&](std::string_view bytes) { text += bytes; });
    write(writer);
    writer.flush();
    return text;
}

std::vector<rib::RequestText> requests_in(const std::string& text) {
    Diagnostics diagnostics([](const Diagnostic& d) { ADD_FAILURE() << to_string(d); });
    rib::Lexer lexer(text, {diagnostics.add_source("a.rib", {}), 1, 1});
    std::vector<rib::RequestText> requests;
    for (rib::RequestText request; rib::read_request(lexer, request, rib::is_request, diagnostics);) {
        EXPECT_EQ(request.problem, "");
        requests.push_back(request);
    }
    return requests;
}

TEST(RibWriter, AsciiIsIndentedByBlocksAndWrapped) {
    const std::string text = written(rib::RibEncoding::Ascii, [](rib::RibWriter& w) {
        w.comment("##RenderMan RIB-Structure 1.1");
        w.request("WorldBegin");
        w.request("Color"), w.numbers(std::vector<float>{1, 0.5f, 0.1f});
        w.request("Surface"), w.string("a \"b\"\\\n"), w.string("Kd"), w.number(-2e-9);
        w.request("Display"), w.strings(std::vector<std::string>{"x", ""});
        w.request("PointsPolygons"), w.integers(std::vector<int>{3, 16777217});
        w.request("WorldEnd");
    });
    EXPECT_EQ(text,
              "##RenderMan RIB-Structure 1.1\n"
              "WorldBegin\n"
              "  Color [1 0.5 0.1]\n"
              "  Surface \"a \\\"b\\\"\\\\\\n\" \"Kd\" -2e-09\n"
              "  Display [\"x\" \"\"]\n"
              "  PointsPolygons [3 16777217]\n"
              "WorldEnd\n");
    const std::string many = written(rib::RibEncoding::Ascii, [](rib::RibWriter& w) {
        w.request("Sphere"), w.numbers(std::vector<float>(500, 1.25f));
    });
    for (size_t at = 0, end; (end = many.find('\n', at)) != std::string::npos; at = end + 1)
        EXPECT_LT(end - at, 130u);
}

/// Arguments of all kinds and sizes come back bit for bit in both encodings.
TEST(RibWriter, WhatIsWrittenReadsBack) {
    std::mt19937 random(5);
    std::vector<float> floats;
    while (floats.size() < 3000) {
        const float f = std::bit_cast<float>(static_cast<uint32_t>(random()));
        if (std::isfinite(f)) floats.push_back(f);
    }
    floats.insert(floats.end(), {0.0f, -0.0f, 1.0f, 127, 128, 32767, 32768, 8388607, 8388608, 1e30f, 1e-45f});
    const std::vector<double> numbers = {0,     1,     -1,    127,        128,        255,     256,
                                         32767, 32768, 65535, 8388607,    8388608,    0.1f,    -0.25,
                                         1e20f, -1e9f, 0.1,   2147483646, 2147483647, 1 << 24, 16777217};
    const std::vector<std::string> strings = {"",
                                              "short",
                                              "fifteen letters",
                                              "sixteen letters.",
                                              std::string(300, 'x'),
                                              std::string(70000, 'y'),
                                              "\" \\ \n \t é"};
    for (const rib::RibEncoding encoding : {rib::RibEncoding::Ascii, rib::RibEncoding::Binary}) {
        const auto requests = requests_in(written(encoding, [&](rib::RibWriter& w) {
            w.request("Polygon"), w.numbers(floats);
            w.request("Sphere");
            for (const double n : numbers) w.number(n);
            w.request("Declare");
            for (const std::string& s : strings) w.string(s);
            w.strings(strings);
            w.request("Sphere"), w.numbers({});
        }));
        ASSERT_EQ(requests.size(), 4u);
        EXPECT_EQ(requests[0].name, "Polygon");
        ASSERT_EQ(requests[0].arguments[0].floats.size(), floats.size());
        for (size_t i = 0; i < floats.size(); ++i)
            EXPECT_EQ(std::bit_cast<uint32_t>(requests[0].arguments[0].floats[i]),
                      std::bit_cast<uint32_t>(floats[i]));
        ASSERT_EQ(requests[1].arguments.size(), numbers.size());
        for (size_t i = 0; i < numbers.size(); ++i) {
            const double number = requests[1].arguments[i].number;
            const bool is_float = static_cast<double>(static_cast<float>(numbers[i])) == numbers[i];
            EXPECT_EQ(is_float ? static_cast<float>(number) : number, numbers[i]) << numbers[i];
        }
        ASSERT_EQ(requests[2].arguments.size(), strings.size() + 1);
        for (size_t i = 0; i < strings.size(); ++i)
            EXPECT_EQ(requests[2].arguments[i].strings[0], strings[i]);
        EXPECT_EQ(requests[2].arguments.back().strings, strings);
        EXPECT_EQ(requests[3].arguments.size(), 1u);
    }
}

TEST(RibWriter, ReadRequestsAreWrittenAgain) {
    const std::string text =
        "PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0] \"int id\" [123456789] Color 1 0 .1\n";
    for (const rib::RibEncoding encoding : {rib::RibEncoding::Ascii, rib::RibEncoding::Binary}) {
        const auto again = [&](const std::string& from) {
            return written(encoding, [&](rib::RibWriter& w) {
                for (const rib::RequestText& request : requests_in(from)) w.write(request);
            });
        };
        const std::string once = again(text);
        EXPECT_EQ(again(once), once);
        const auto requests = requests_in(once);
        ASSERT_EQ(requests.size(), 2u);
        ASSERT_EQ(requests[0].arguments.size(), 6u);
        ASSERT_EQ(requests[0].arguments[5].large_integers.size(), 1u);
        EXPECT_EQ(requests[0].arguments[5].large_integers[0].second, 123456789);
    }
}

TEST(GzipWriter, WhatIsPackedUnpacks) {
    std::string text;
    for (int i = 0; i < 200000; ++i) text += std::to_string(i * 7919 % 1000) + " ";
    std::string packed;
    rib::GzipWriter gzip([&](std::string_view bytes) { packed += bytes; });
    gzip.add(std::string_view(text).substr(0, 1000));
    gzip.add({});
    gzip.add(std::string_view(text).substr(1000));
    gzip.finish();
    EXPECT_LT(packed.size(), text.size() / 2);
    const Folder folder;
    const std::string path = folder.write("a.gz", packed);
    gzFile file = gzopen(path.c_str(), "rb");
    std::string unpacked(text.size() + 10, '\0');
    EXPECT_EQ(gzread(file, unpacked.data(), static_cast<unsigned>(unpacked.size())),
              static_cast<int>(text.size()));
    gzclose(file);
    unpacked.resize(text.size());
    EXPECT_EQ(unpacked, text);
}

}  // namespace
}  // namespace trapeze::testing
