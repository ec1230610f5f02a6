/// A reader of .ptc files for tests, written after Partio's (wdas/partio, src/lib/io/PTC.cpp, readPTC()):
/// what it takes from where, in its order, and how it decodes normals. It shares no code with ptc_file.cpp.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace trapeze::testing {

struct PartioParticle {
    std::array<float, 3> position, normal;
    float radius;
    std::map<std::string, std::vector<float>> attributes;
};

struct PartioFile {
    int version = -1;
    std::array<float, 6> bounds{};
    std::vector<std::string> specs;  ///< "color _name"
    std::vector<PartioParticle> particles;
    std::string left;  ///< behind the last particle
};

inline PartioFile read_as_partio(const std::string& bytes) {
    std::istringstream input(bytes);
    const auto take = [&]<class Number>(Number& number) {
        input.read(reinterpret_cast<char*>(&number), sizeof number);
        ASSERT_TRUE(input) << "the file ends early";
    };
    PartioFile file;
    int magic = 0, variables = 0, data_size = 0;
    double count = 0;
    float ignored = 0;
    take(magic);
    EXPECT_EQ(magic, ((((('c' << 8) | 't') << 8) | 'p') << 8) | 'p');
    take(file.version);
    EXPECT_LE(file.version, 2);
    take(count);
    for (float& side : file.bounds) take(side);
    if (file.version >= 1)
        for (int i = 0; i < 4; ++i) take(ignored);
    if (file.version >= 2)
        for (int i = 0; i < 33; ++i) take(ignored);
    for (int i = 0; i < 16 + 16 + 3; ++i) take(ignored);
    take(variables), take(data_size);
    const std::map<std::string, int> sizes{{"normal", 3}, {"vector", 3}, {"point", 3},
                                           {"color", 3},  {"float", 1},  {"matrix", 16}};
    std::vector<std::pair<std::string, int>> attributes;
    for (int i = 0, parsed = 0; i < variables; ++i) {
        std::string line;
        std::getline(input, line, '\n');
        const size_t space = line.find(' ');
        const auto size = sizes.find(line.substr(0, space));
        EXPECT_TRUE(size != sizes.end()) << line;
        if (size == sizes.end()) return file;
        file.specs.push_back(line);
        attributes.emplace_back(line.substr(line.find_first_not_of(' ', space)), size->second);
        parsed += size->second;
        EXPECT_TRUE(i + 1 < variables || parsed == data_size) << parsed;
    }
    if (file.version >= 1) take(ignored), take(ignored);
    for (int i = 0; i < count && input; ++i) {
        PartioParticle particle;
        for (float& x : particle.position) take(x);
        unsigned short phi = 0, z = 0;
        take(phi), take(z);
        if (phi != 65535 || z != 65535) {
            particle.normal[2] = 2.0f * (static_cast<float>(z) / 65535.0f) - 1.0f;
            const double angle = 2.0 * M_PI * (static_cast<double>(static_cast<float>(phi) / 65535.0f) - 0.5);
            const double beside =
                std::sqrt(std::max(0.0, 1.0 - static_cast<double>(particle.normal[2]) * particle.normal[2]));
            particle.normal[0] = static_cast<float>(beside * std::sin(angle));
            particle.normal[1] = static_cast<float>(beside * std::cos(angle));
        } else {
            particle.normal = {0, 0, 0};
        }
        take(particle.radius);
        for (const auto& [name, size] : attributes) {
            std::vector<float>& values = particle.attributes[name];
            values.resize(static_cast<size_t>(size));
            for (float& value : values) take(value);
        }
        file.particles.push_back(std::move(particle));
    }
    file.left = bytes.substr(static_cast<size_t>(input.tellg()));
    return file;
}

}  // namespace trapeze::testing
