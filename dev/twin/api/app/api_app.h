/* What the files of this application share: the words of a line of the script, and the answer to it. */
#ifndef API_APP_H
#define API_APP_H

#include "cfe.h"
#include "cfe_psp.h"

#define SLOTS 100

typedef struct
{
    const char *name;
    void (*run)(void);
} Call;

#define CALL(call) static void Do_##call(void)
#define ROW(call) {#call, Do_##call}

extern const Call EsCalls[], BusCalls[], MsgCalls[], OsalCalls[], PspCalls[];

extern uint32 Slots[SLOTS]; /* ids that calls gave, for later calls */

long long   Num(int word);                     /* a number, or the content of slot $n */
const char *Text(int word);                    /* a text: 'abc with %xx for what is no plain character */
uint8 *     Bytes(int word, size_t *size);     /* bytes: xHEX; a copy with 64 spare bytes behind, good until the next line */
int         Words(void);                       /* how many words follow the name of the call */
void        Status(int32 status);              /* first word of the answer; below 0 it is the last, too */
void        OutNum(long long value);           /* further words */
void        OutText(const char *text, size_t most);
void        OutBytes(const void *data, size_t size);
void        OutId(unsigned long id);
void        Keep(int word, unsigned long id);  /* answer with an id, and keep it in slot @n */
void        ChildMain(void);                   /* main function of child tasks: ends by itself at the next line for it */

#define APPID(word) ((CFE_ES_AppId_t)CFE_RESOURCEID_WRAP(CFE_ResourceId_FromInteger((uint32)Num(word))))
#define OSID(word) OS_ObjectIdFromInteger((uint32)Num(word))
#define RAW(id) CFE_RESOURCEID_TO_ULONG(id)

#endif
