// Tests of GoogleTest as a node: what came of them is a file in the flight computer's RAM disk, /ram/gtest.xml, as GoogleTest's
// own --gtest_output writes it.
#include <string>

#include <gtest/gtest.h>

extern "C" {
#include "osapi.h"
}

namespace
{

std::string quoted(const std::string &text)
{
    std::string made = "\"";
    for (const char c : text)
    {
        switch (c)
        {
            case '&':
                made += "&amp;";
                break;
            case '<':
                made += "&lt;";
                break;
            case '>':
                made += "&gt;";
                break;
            case '"':
                made += "&quot;";
                break;
            case '\n':
                made += "&#x0A;";
                break;
            default:
                made += static_cast<unsigned char>(c) < 0x20 ? ' ' : c; // XML has no others
        }
    }
    return made + '"';
}

std::string counts(int tests, int failures)
{
    return " tests=\"" + std::to_string(tests) + "\" failures=\"" + std::to_string(failures) + "\" errors=\"0\"";
}

std::string failures_of(const testing::TestResult &result)
{
    std::string made;
    for (int i = 0; i < result.total_part_count(); ++i)
    {
        const testing::TestPartResult &part = result.GetTestPartResult(i);
        if (part.failed())
        {
            const char *      file  = part.file_name() != nullptr ? part.file_name() : "unknown file";
            const std::string where = part.line_number() >= 0 ? ":" + std::to_string(part.line_number()) : "";
            made += "<failure message=" + quoted(file + where + "\n" + part.message()) + "/>";
        }
    }
    return made;
}

std::string case_of(const std::string &suite, const std::string &name, const testing::TestResult &result)
{
    return "<testcase classname=" + quoted(suite) + " name=" + quoted(name) + " time=\"" +
           std::to_string(static_cast<double>(result.elapsed_time()) / 1000) + "\">" + failures_of(result) + "</testcase>\n";
}

std::string suite_of(const testing::TestSuite &suite)
{
    std::string cases;
    for (int i = 0; i < suite.total_test_count(); ++i)
    {
        const testing::TestInfo &test = *suite.GetTestInfo(i);
        if (test.should_run())
        {
            cases += case_of(suite.name(), test.name(), *test.result());
        }
    }
    int        failed = suite.failed_test_count();
    const bool around = suite.ad_hoc_test_result().Failed(); // SetUpTestSuite, TearDownTestSuite
    if (around)
    {
        cases += case_of(suite.name(), "", suite.ad_hoc_test_result());
        ++failed;
    }
    return "<testsuite name=" + quoted(suite.name()) + counts(suite.test_to_run_count() + (around ? 1 : 0), failed) + ">\n" +
           cases + "</testsuite>\n";
}

class Results : public testing::EmptyTestEventListener
{
    void OnTestProgramEnd(const testing::UnitTest &tests) override
    {
        std::string suites;
        for (int i = 0; i < tests.total_test_suite_count(); ++i)
        {
            if (tests.GetTestSuite(i)->should_run())
            {
                suites += suite_of(*tests.GetTestSuite(i));
            }
        }
        if (tests.ad_hoc_test_result().Failed()) // environments
        {
            suites += "<testsuite name=\"\"" + counts(1, 1) + ">\n" + case_of("", "", tests.ad_hoc_test_result()) +
                      "</testsuite>\n";
        }
        write("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" +
              counts(tests.test_to_run_count(), tests.failed_test_count()) + ">\n" + suites + "</testsuites>\n");
    }

    static void write(const std::string &text)
    {
        osal_id_t file;
        if (OS_OpenCreate(&file, "/ram/gtest.xml", OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY) == OS_SUCCESS)
        {
            OS_write(file, text.data(), text.size());
            OS_close(file);
        }
    }
};

const bool g_listens = (testing::UnitTest::GetInstance()->listeners().Append(new Results), true);

} // namespace
