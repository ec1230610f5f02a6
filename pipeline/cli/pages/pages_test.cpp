#include "pipeline/cli/pages/pages.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "pipeline/cli/pages/command_table.h"
#include "pipeline/cli/pages/completions.h"
#include "pipeline/cli/pages/man_page.h"

namespace trapeze {
namespace {

/// A program of one command that has options of each kind.
struct Sample {
    CLI::App app{"Boil: cooks eggs."};
    int minutes = 3;
    bool is_salted = false;
    std::vector<std::string> eggs;
    std::string mood, stove;

    Sample() {
        app.name("boil");
        CLI::App* const command = app.add_subcommand("egg", "cooks; it's done - soon");
        command->add_option("eggs", eggs, "eggs")->required()->type_name("SCENE.egg");
        command->add_option("-m,--minutes", minutes, ".5 or more\\less")
            ->type_name("N like 3")
            ->capture_default_str();
        command->add_flag("--salt", is_salted, "with [sea] salt");
        command->add_option("--mood", mood, "how")->check(CLI::IsMember({"soft", "hard"}));
        command->add_option("--stove", stove, "the stove, one of: gas:size=1 wood");
        command->add_option("--secret", stove, "a secret")->group("");
    }
};

TEST(Pages, TheTableIsThatOfHelp) {
    const Sample sample;
    const CommandText table = table_of(sample.app);
    ASSERT_EQ(table.commands.size(), 1u);
    const CommandText& egg = table.commands[0];
    ASSERT_EQ(egg.words.size(), 1u);
    EXPECT_TRUE(egg.words[0].is_list && egg.words[0].is_required && egg.words[0].takes_file());
    ASSERT_EQ(egg.options.size(), 5u) << "--help and all but the secret";
    EXPECT_EQ(egg.options[1].names, (std::vector<std::string>{"-m", "--minutes"}));
    EXPECT_EQ(egg.options[1].value, "N");
    EXPECT_EQ(egg.options[1].example, "3");
    EXPECT_EQ(egg.options[1].by_default, "3");
    EXPECT_TRUE(egg.options[2].is_flag());
    EXPECT_EQ(egg.options[3].choices.size(), 2u);
    EXPECT_EQ(egg.options[4].choices, (std::vector<std::string>{"gas", "wood"}));
    EXPECT_EQ(brief(egg.about), "cooks");
}

TEST(Pages, LettersThatRoffTakesForItsOwnAreMarked) {
    EXPECT_EQ(roff_text(".5 a-b"), "\\&.5 a\\-b");
    EXPECT_EQ(roff_text("a\n'b\\c`"), "a\n\\&\\(aqb\\ec\\(ga");
    EXPECT_EQ(roff_text("plain."), "plain.");
    EXPECT_EQ(roff_text("a,b, c"), "a,\\:b, c") << "may be broken";
    EXPECT_EQ(roff_text("a|b"), "a|\\:b");
}

TEST(Pages, WordsThatShellsTakeForTheirOwnAreMarked) {
    const Sample sample;
    const CommandText table = table_of(sample.app);
    EXPECT_NE(fish_completion(table).find("-l salt -d 'with [sea] salt'"), std::string::npos);
    EXPECT_NE(zsh_completion(table).find("--salt'[with \\[sea\\] salt]'"), std::string::npos);
    EXPECT_NE(zsh_completion(table).find("{-m+,--minutes=}"), std::string::npos);
    EXPECT_NE(bash_completion(table).find("'egg --mood') words='"), std::string::npos);
}

TEST(Pages, WhatIsNotThereIsSaid) {
    const Sample sample;
    EXPECT_TRUE(asks_for_page({"help", "--man"}));
    EXPECT_FALSE(asks_for_page({"help", "egg"}));
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"help", "--man", "ham"},
                                                  {"help", "--man", "egg", "egg"},
                                                  {"help", "--completions"},
                                                  {"help", "--completions", "csh"}}) {
        std::string problem;
        EXPECT_EQ(page_for(wrong, sample.app, "1", &problem), "");
        EXPECT_NE(problem, "");
    }
}

}  // namespace
}  // namespace trapeze
