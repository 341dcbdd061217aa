/*
 * An application of cFE that plays a script of API calls and writes down what each answers.
 *
 * A line of the script is: the task that calls (A this application, B another one, C a child task), the name of the
 * call, its arguments. A line of the answers is: the number of the line, the status, the outputs. Below it stand the
 * events that came meanwhile (E application, id, type, text) and the new text of the system log (L line).
 */
#define _XOPEN_SOURCE 600
#include "api_app.h"

#include <ctype.h>
#include <semaphore.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cfe_es_resetdata_typedef.h"
#include "cfe_evs_msg.h"
#include "cfe_msgids.h"

#define MOST_WORDS 40
#define LONGEST 40000

uint32 Slots[SLOTS];

static char * Word[MOST_WORDS];
static int    WordCount;
static char   Line[LONGEST];
static char   Answer[4 * LONGEST];
static size_t AnswerSize;
static bool   IsOver; /* the status was an error: no outputs */
static void * Loans[MOST_WORDS];
static int    LoanCount;
static FILE * Out;
static sem_t  Turn[2], Done;
static bool   ChildEnds;

static void Add(const char *format, ...)
{
    va_list list;

    if (IsOver)
    {
        return;
    }
    va_start(list, format);
    AnswerSize += vsnprintf(Answer + AnswerSize, sizeof(Answer) - AnswerSize, format, list);
    va_end(list);
}

int Words(void)
{
    return WordCount - 2;
}

static const char *At(int word)
{
    return word + 1 < WordCount ? Word[word + 1] : "0";
}

long long Num(int word)
{
    const char *text = At(word);

    return *text == '$' ? (long long)Slots[atoi(text + 1)] : strtoll(text, NULL, 0);
}

static void *Loan(size_t size)
{
    void *data = calloc(1, size + 64);

    Loans[LoanCount++] = data;
    return data;
}

static int Hex(const char *text)
{
    char two[3] = {text[0], text[1], 0};

    return (int)strtol(two, NULL, 16);
}

const char *Text(int word)
{
    const char *from = At(word) + 1;
    char *      text = Loan(strlen(from) + 1), *to = text;

    for (; *from; ++from)
    {
        *to++ = *from == '%' ? (char)Hex(from + 1) : *from;
        from += *from == '%' ? 2 : 0;
    }
    return text;
}

uint8 *Bytes(int word, size_t *size)
{
    const char *from = At(word) + 1;
    uint8 *     data = Loan(strlen(from) / 2);
    size_t      at;

    *size = strlen(from) / 2;
    for (at = 0; at < *size; ++at)
    {
        data[at] = (uint8)Hex(from + 2 * at);
    }
    return data;
}

void Status(int32 status)
{
    Add(" %d", (int)status);
    IsOver = status < 0;
}

void OutNum(long long value)
{
    Add(" %lld", value);
}

void OutText(const char *text, size_t most)
{
    Add(" '");
    for (; most > 0 && *text; --most, ++text)
    {
        Add(isalnum((unsigned char)*text) || strchr("_-./:", *text) ? "%c" : "%%%02x", (unsigned char)*text);
    }
}

void OutBytes(const void *data, size_t size)
{
    const uint8 *from = data;

    Add(" x");
    for (; size > 0; --size)
    {
        Add("%02x", *from++);
    }
}

void OutId(unsigned long id)
{
    Add(" #%lx", id);
}

void Keep(int word, unsigned long id)
{
    if (!IsOver)
    {
        Slots[atoi(At(word) + 1)] = (uint32)id;
        OutId(id);
    }
}

static void Perform(void)
{
    static const Call *const tables[] = {EsCalls, BusCalls, MsgCalls, OsalCalls, PspCalls};
    size_t                   table;
    const Call *             call;

    for (table = 0; table < sizeof(tables) / sizeof(tables[0]); ++table)
    {
        for (call = tables[table]; call->name != NULL; ++call)
        {
            if (strcmp(call->name, Word[1]) == 0)
            {
                call->run();
                return;
            }
        }
    }
    Add(" unknown");
}

static void Serve(int who)
{
    while (true)
    {
        sem_wait(&Turn[who]);
        Perform();
        sem_post(&Done);
    }
}

static void ServeChild(void)
{
    Serve(1);
}

void ChildMain(void)
{
    while (!ChildEnds)
    {
        OS_TaskDelay(50);
        CFE_ES_IncrementTaskCounter();
    }
    CFE_ES_ExitChildTask();
}

static void ReadLine(void)
{
    char *rest = NULL;

    for (WordCount = 0; WordCount < MOST_WORDS; ++WordCount)
    {
        Word[WordCount] = strtok_r(WordCount == 0 ? Line : NULL, " \n", &rest);
        if (Word[WordCount] == NULL)
        {
            break;
        }
    }
    AnswerSize = 0;
    IsOver     = false;
}

static void Escaped(const char *text, size_t most)
{
    AnswerSize = 0;
    IsOver     = false;
    OutText(text, most);
    fprintf(Out, "%s", Answer);
}

static void DrainEvents(CFE_SB_PipeId_t pipe)
{
    CFE_SB_Buffer_t *                buffer;
    const CFE_EVS_LongEventTlm_t *   event;

    while (CFE_SB_ReceiveBuffer(&buffer, pipe, CFE_SB_POLL) == CFE_SUCCESS)
    {
        event = (const void *)buffer;
        fprintf(Out, "E %s %d %d", event->Payload.PacketID.AppName, (int)event->Payload.PacketID.EventID,
                (int)event->Payload.PacketID.EventType);
        Escaped(event->Payload.Message, sizeof(event->Payload.Message));
        fprintf(Out, "\n");
    }
}

static void DrainLog(void)
{
    CFE_ES_ResetData_t *data;
    cpuaddr             address;
    uint32              size;
    size_t              at, begin = 0;

    CFE_PSP_GetResetArea(&address, &size);
    data = (CFE_ES_ResetData_t *)address;
    for (at = 0; at < data->SystemLogWriteIdx; ++at)
    {
        if (data->SystemLog[at] == '\n')
        {
            fprintf(Out, "L");
            Escaped(data->SystemLog + begin, at - begin);
            fprintf(Out, "\n");
            begin = at + 1;
        }
    }
    data->SystemLogWriteIdx = data->SystemLogEndIdx = 0;
}

static void Clear(void)
{
    while (LoanCount > 0)
    {
        free(Loans[--LoanCount]);
    }
}

void API_AuxMain(void) /* stands before API_Main in the startup script */
{
    sem_init(&Turn[0], 0, 0);
    sem_init(&Turn[1], 0, 0);
    sem_init(&Done, 0, 0);
    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    Serve(0);
}

void API_Main(void)
{
    static const CFE_SB_Qos_t quality;
    CFE_SB_PipeId_t           pipe;
    CFE_ES_TaskId_t           child;
    FILE *                    script = fopen("script.txt", "r");
    unsigned long             number = 0;

    Out = fopen("answers.txt", "w");
    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    CFE_ES_WaitForSystemState(CFE_ES_SystemState_OPERATIONAL, 20000);
    OS_TaskDelay(500);
    CFE_SB_CreatePipe(&pipe, 50, "API_EVENTS");
    CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(CFE_EVS_LONG_EVENT_MSG_MID), pipe, quality, 50);
    CFE_ES_CreateChildTask(&child, "API_CHILD", ServeChild, CFE_ES_TASK_STACK_ALLOCATE, 65536, 150, 0);
    OS_TaskDelay(200);
    DrainLog();
    DrainEvents(pipe);
    fprintf(Out, "begin\n");
    while (fgets(Line, sizeof(Line), script) != NULL)
    {
        ++number;
        ReadLine();
        fflush(Out);
        if (WordCount < 2)
        {
            continue;
        }
        if (Word[0][0] == 'A')
        {
            Perform();
        }
        else
        {
            sem_post(&Turn[Word[0][0] == 'B' ? 0 : 1]);
            sem_wait(&Done);
        }
        fprintf(Out, "%lu%.*s\n", number, (int)AnswerSize, Answer);
        DrainEvents(pipe);
        DrainLog();
        Clear();
    }
    ChildEnds = true;
    fprintf(Out, "end\n");
    fclose(Out);
    _exit(0); /* there is nothing to tidy up in a process that was started for one script */
}
