// diagnostic_updater::DiagnosticStatusWrapper: a status with functions that fill it.
#ifndef ROSCFE_DIAGNOSTIC_UPDATER_DIAGNOSTICSTATUSWRAPPER_H
#define ROSCFE_DIAGNOSTIC_UPDATER_DIAGNOSTICSTATUSWRAPPER_H

#include <cstdarg>
#include <cstdio>
#include <sstream>
#include <string>

#include "diagnostic_msgs/DiagnosticStatus.h"
#include "ros/ros.h"

namespace diagnostic_updater
{

class DiagnosticStatusWrapper : public diagnostic_msgs::DiagnosticStatus
{
  public:
    void summary(unsigned char level_, const std::string &text)
    {
        level   = static_cast<signed char>(level_);
        message = text.c_str();
    }
    void summary(const diagnostic_msgs::DiagnosticStatus &other)
    {
        summary(static_cast<unsigned char>(other.level), other.message.c_str());
    }
    void summaryf(unsigned char level_, const char *format, ...) __attribute__((format(printf, 3, 4)))
    {
        va_list arguments;
        va_start(arguments, format);
        summary(level_, formatted(format, arguments));
        va_end(arguments);
    }
    void clearSummary() { summary(0, ""); }

    // Two summaries as one: the worse level, and the texts of those that are as bad or, when all is well, of both.
    void mergeSummary(unsigned char level_, const std::string &text)
    {
        const bool is_bad = level_ > 0, was_bad = level > 0;
        if (is_bad == was_bad)
        {
            if (!message.empty() && !text.empty())
            {
                message += "; ";
            }
            message += text.c_str();
        }
        else if (is_bad)
        {
            message = text.c_str();
        }
        if (level_ > static_cast<unsigned char>(level))
        {
            level = static_cast<signed char>(level_);
        }
    }
    void mergeSummary(const diagnostic_msgs::DiagnosticStatus &other)
    {
        mergeSummary(static_cast<unsigned char>(other.level), other.message.c_str());
    }
    void mergeSummaryf(unsigned char level_, const char *format, ...) __attribute__((format(printf, 3, 4)))
    {
        va_list arguments;
        va_start(arguments, format);
        mergeSummary(level_, formatted(format, arguments));
        va_end(arguments);
    }

    template <class T>
    void add(const std::string &key, const T &value)
    {
        std::ostringstream text;
        text << value;
        put(key, text.str());
    }
    void add(const std::string &key, bool value) { put(key, value ? "True" : "False"); }
    void addf(const std::string &key, const char *format, ...) __attribute__((format(printf, 3, 4)))
    {
        va_list arguments;
        va_start(arguments, format);
        put(key, formatted(format, arguments));
        va_end(arguments);
    }
    void clear() { values.clear(); }

  private:
    static std::string formatted(const char *format, va_list arguments)
    {
        char text[1000];
        std::vsnprintf(text, sizeof text, format, arguments);
        return text;
    }
    void put(const std::string &key, const std::string &value)
    {
        values.emplace_back();
        values.back().key   = key.c_str();
        values.back().value = value.c_str();
    }
};

} // namespace diagnostic_updater

#endif
