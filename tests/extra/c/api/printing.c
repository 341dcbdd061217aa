/* What OS_printf shows: texts up to a length, lines put together from pieces, and what it leaves out while disabled. */
#include "api_test.h"

static char text[1000];

static const char *letters(int count)
{
    for (int i = 0; i < count; i++)
        text[i] = (char)('a' + i % 26);
    text[count] = 0;
    return text;
}

void APITEST_Main(void)
{
    SAY("begin");
    OS_printf("%s\n", letters(169));
    OS_printf("%s\n", letters(170));
    OS_printf("%s", letters(170));
    OS_printf("\n");
    OS_printf("%s", letters(171));
    OS_printf("\n");
    OS_printf("%s", letters(172));
    OS_printf("\n");
    OS_printf("%s\n", letters(171));
    OS_printf("|%s", letters(400));
    OS_printf("|\n");
    for (int i = 0; i < 6; i++)
        OS_printf("[%d]%s", i, letters(60));
    OS_printf("\n");
    for (int i = 0; i < 3; i++)
        OS_printf("<%d>%s", i, letters(300));
    OS_printf("\n");
    OS_printf("%s\n%s\n", letters(100), letters(100));
    OS_printf("one\ntwo\n\nfour\n");
    OS_printf("shown, ");
    OS_printf_disable();
    OS_printf("hidden, ");
    OS_printf("hidden\n");
    OS_printf_enable();
    OS_printf("shown\n");
    OS_printf_disable();
    OS_printf("hidden, ");
    OS_printf_enable();
    OS_printf("shown\n");
    OS_printf("%s", "");
    OS_printf("%c%s\n", 0, "behind a NUL");
    OS_printf("\n");
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
