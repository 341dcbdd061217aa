/* Declarations for compiled applications of tests: the functions of cFE and OSAL that they use, in plain C types. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif
int32_t CFE_ES_WriteToSysLog(const char *, ...) __attribute__((format(printf, 1, 2)));
bool CFE_ES_RunLoop(uint32_t *);
void CFE_ES_ExitApp(uint32_t);
int32_t CFE_ES_CreateChildTask(uint32_t *, const char *, void (*)(void), void *, size_t, uint16_t, uint32_t);
int32_t CFE_EVS_Register(const void *, uint16_t, uint16_t);
int32_t CFE_EVS_SendEvent(uint16_t, uint16_t, const char *, ...) __attribute__((format(printf, 3, 4)));
int32_t CFE_SB_CreatePipe(uint32_t *, uint16_t, const char *);
int32_t CFE_SB_DeletePipe(uint32_t);
int32_t CFE_SB_Subscribe(uint32_t, uint32_t);
int32_t CFE_SB_TransmitMsg(const void *, bool);
int32_t CFE_SB_ReceiveBuffer(void **, uint32_t, int32_t);
void *CFE_SB_AllocateMessageBuffer(size_t);
int32_t CFE_SB_ReleaseMessageBuffer(void *);
int32_t CFE_SB_TransmitBuffer(void *, bool);
int32_t CFE_MSG_Init(void *, uint32_t, size_t);
int32_t CFE_MSG_GetSize(const void *, size_t *);
uint64_t CFE_TIME_GetTime(void);
int32_t CFE_MSG_SetSize(void *, size_t);
int32_t CFE_TBL_Register(int16_t *, const char *, size_t, uint16_t, int32_t (*)(void *));
int32_t CFE_TBL_Load(int16_t, uint32_t, const void *);
int32_t CFE_TBL_GetAddress(void **, int16_t);
int32_t CFE_TBL_ReleaseAddress(int16_t);
int32_t OS_TaskDelay(uint32_t);
int32_t OS_GetLocalTime(int64_t *);
int32_t OS_MutSemCreate(uint32_t *, const char *, uint32_t);
int32_t OS_MutSemTake(uint32_t);
int32_t OS_MutSemGive(uint32_t);
int32_t OS_BinSemCreate(uint32_t *, const char *, uint32_t, uint32_t);
int32_t OS_BinSemTake(uint32_t);
int32_t OS_BinSemGive(uint32_t);
void OS_printf(const char *, ...) __attribute__((format(printf, 1, 2)));
#ifndef __cplusplus
int snprintf(char *, size_t, const char *, ...);
#endif
#ifdef __cplusplus
}
#endif

#define SAY(...) CFE_ES_WriteToSysLog("> " __VA_ARGS__)
#define RUN 1
#define EXIT 2
