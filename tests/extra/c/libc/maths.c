/* libm, with errno, flags and rounding. */
#include "trial.h"

#include <fenv.h>
#include <math.h>

static const double values[] = {
    0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 2.0, 3.0, -3.0, 0.1, 1.5, 2.5, -2.5, 10.0, 100.25, 1e10, -1e10, 1e300, -1e300, 1e-300, 5e-324, 2.2250738585072014e-308, 709.0, 710.0, -745.0, -746.0, 1024.0,
    171.0, 172.0, -4.0, 4503599627370497.5, 9.3e18, INFINITY, -INFINITY, NAN, M_PI, M_PI_2, 1e22, 3e38, 1e39, 1e-40, 2147483648.5,
};

#define FLAGS (fetestexcept(FE_ALL_EXCEPT & ~FE_INEXACT))
#define BEGIN errno = 0, feclearexcept(FE_ALL_EXCEPT)
#define ONE(name)                                                                                    \
    EACH(const double, x, values) {                                                                  \
        BEGIN;                                                                                       \
        double d = name(*x);                                                                         \
        int de = errno, df = FLAGS;                                                                  \
        BEGIN;                                                                                       \
        float f = name##f((float)*x);                                                                \
        int fe = errno, ff = FLAGS;                                                                  \
        BEGIN;                                                                                       \
        long double l = name##l(*x);                                                                 \
        int le = errno, lf = FLAGS;                                                                  \
        SAY(#name " %a: %a %d %d, %a %d %d, %La %d %d", *x, d, de, df, f, fe, ff, l, le, lf);         \
    }
#define TWO(name)                                                                                    \
    EACH(const double, x, values)                                                                    \
        EACH(const double, y, values) {                                                              \
            BEGIN;                                                                                   \
            double d = name(*x, *y);                                                                 \
            int de = errno, df = FLAGS;                                                              \
            BEGIN;                                                                                   \
            float f = name##f((float)*x, (float)*y);                                                 \
            int fe = errno, ff = FLAGS;                                                              \
            BEGIN;                                                                                   \
            long double l = name##l(*x, *y);                                                         \
            int le = errno, lf = FLAGS;                                                              \
            SAY(#name " %a %a: %a %d %d, %a %d %d, %La %d %d", *x, *y, d, de, df, f, fe, ff, l, le, lf); \
        }
#define TO_INTEGER(name)                                                                             \
    EACH(const double, x, values) {                                                                  \
        BEGIN;                                                                                       \
        long long d = name(*x);                                                                      \
        int de = errno;                                                                              \
        long long f = name##f((float)*x), l = name##l(*x);                                           \
        SAY(#name " %a: %lld %d %lld %lld", *x, d, de, f, l);                                         \
    }
#define WITH(name, ...)                                                                              \
    EACH(const double, x, values) {                                                                  \
        static const int others[] = {0, 1, -1, 5, -30, 2000, -2000};                                 \
        EACH(const int, n, others) {                                                                 \
            BEGIN;                                                                                   \
            double d = name(__VA_ARGS__);                                                            \
            int de = errno, df = FLAGS;                                                              \
            SAY(#name " %a %d: %a %d %d", *x, *n, d, de, df);                                         \
        }                                                                                            \
    }

static void each_of_one(void)
{
    ONE(acos) ONE(asin) ONE(atan) ONE(cos) ONE(sin) ONE(tan) ONE(acosh) ONE(asinh) ONE(atanh) ONE(cosh) ONE(sinh) ONE(tanh)
    ONE(exp) ONE(exp2) ONE(exp10) ONE(expm1) ONE(log) ONE(log2) ONE(log10) ONE(log1p) ONE(logb) ONE(sqrt) ONE(cbrt) ONE(fabs)
    ONE(erf) ONE(erfc) ONE(tgamma) ONE(ceil) ONE(floor) ONE(trunc) ONE(round) ONE(rint) ONE(nearbyint) ONE(j0) ONE(j1) ONE(y0) ONE(y1)
    TO_INTEGER(lround) TO_INTEGER(llround) TO_INTEGER(lrint) TO_INTEGER(llrint) TO_INTEGER(ilogb)
}

static void each_of_two(void)
{
    TWO(pow) TWO(atan2) TWO(hypot) TWO(fmod) TWO(remainder) TWO(fmin) TWO(fmax) TWO(fdim) TWO(copysign) TWO(nextafter) TWO(nexttoward)
}

static void others(void)
{
    WITH(ldexp, *x, *n) WITH(scalbn, *x, *n) WITH(scalbln, *x, *n) WITH(jn, *n % 5, *x) WITH(yn, *n % 5, *x)
    WITH(ldexpf, (float)*x, *n) WITH(scalbnl, *x, *n) WITH(scalblnf, (float)*x, *n)
    EACH(const double, x, values) {
        int n = 0, sign = 0, fn = 0, ln = 0, quotient = 0;
        double whole = 0, s = 0, c = 0;
        float fwhole = 0, fs = 0, fc = 0;
        long double lwhole = 0, ls = 0, lc = 0;
        SAY("frexp %a: %a %a %La", *x, frexp(*x, &n), frexpf((float)*x, &fn), frexpl(*x, &ln));
        SAY("%d %d %d", isfinite(*x) ? n : 0, isfinite((float)*x) ? fn : 0, isfinite(*x) ? ln : 0);
        double part = modf(*x, &whole);
        float fpart = modff((float)*x, &fwhole);
        long double lpart = modfl(*x, &lwhole);
        SAY("modf %a %a, %a %a, %La %La", part, whole, fpart, fwhole, lpart, lwhole);
        BEGIN;
        signgam = 0;
        double gamma = lgamma(*x);
        SAY("lgamma %a %d %d %d, %a %La", gamma, signgam, errno, FLAGS, lgammaf((float)*x), lgammal(*x));
        double again = lgamma_r(*x, &sign);
        SAY("%a %d", again, sign);
        sincos(*x, &s, &c);
        sincosf((float)*x, &fs, &fc);
        sincosl(*x, &ls, &lc);
        SAY("sincos %a %a %a %a %La %La", s, c, fs, fc, ls, lc);
        double rest = remquo(*x, 0.75, &quotient);
        SAY("remquo %a %d, fma %a %a %La", rest, isnan(rest) ? 0 : quotient & 7, fma(*x, 3.1, -0.3), fmaf((float)*x, 3.1f, -0.3f), fmal(*x, 3.1L, -0.3L));
        SAY("class %d %d %d %d %d %d", fpclassify(*x), !!signbit(*x), !!__isinf(*x), !!__isnan(*x), !!(finite)(*x), !!(isnanf)((float)*x));
    }
    SAY("%a %a %La %a", nan(""), nanf("12"), nanl("0x7"), nan("x"));
}

static void roundings(void)
{
    static const int modes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    volatile double one = 1.0, three = 3.0, tenth = 0.1;
    volatile long double lone = 1.0L, lthree = 3.0L;
    EACH(const int, mode, modes) {
        SAY("set %d", fesetround(*mode));
        int now = fegetround();
        double third = one / three, root = sqrt(three);
        long double lthird = lone / lthree;
        char text[100];
        SAY("%d: %a %La %a, %a %a %a %ld %ld", now == *mode, third, lthird, root, rint(2.5), rint(-2.5), nearbyint(1.1), lrint(2.5), lrintf(-1.5f));
        snprintf(text, sizeof text, "%.2f %.0f %.3e", 1.005, 2.5, tenth);
        SAY("%s %a %a %La", text, strtod("0.1", NULL), strtof("0.1", NULL), strtold("0.1", NULL));
    }
    fesetround(FE_TONEAREST);
}

static void flags(void)
{
    volatile double zero = 0.0, one = 1.0, huge = 1e308;
    volatile long double lzero = 0.0L, lone = 1.0L;
    static const int all[] = {FE_INVALID, FE_DIVBYZERO, FE_OVERFLOW, FE_UNDERFLOW, FE_INEXACT, FE_ALL_EXCEPT, 0};
    EACH(const int, which, all) {
        fenv_t kept;
        fexcept_t some;
        feclearexcept(FE_ALL_EXCEPT);
        SAY("raise %d %d", feraiseexcept(*which) == 0, (fetestexcept(FE_ALL_EXCEPT) & *which) == *which);
        fegetexceptflag(&some, FE_ALL_EXCEPT);
        SAY("hold %d %d", feholdexcept(&kept), fetestexcept(FE_ALL_EXCEPT));
        volatile double infinite = one / zero;
        SAY("%a %d", infinite, !!fetestexcept(FE_DIVBYZERO));
        SAY("update %d %d", feupdateenv(&kept), !!fetestexcept(FE_DIVBYZERO));
        feclearexcept(FE_ALL_EXCEPT);
        fesetexceptflag(&some, FE_ALL_EXCEPT);
        SAY("%d", (fetestexcept(FE_ALL_EXCEPT) & *which) == *which);
        fegetenv(&kept);
        fesetenv(FE_DFL_ENV);
        SAY("%d", fetestexcept(FE_ALL_EXCEPT));
        fesetenv(&kept);
        SAY("%d", (fetestexcept(FE_ALL_EXCEPT) & *which) == *which);
    }
    feclearexcept(FE_ALL_EXCEPT);
    volatile long double linfinite = lone / lzero;
    SAY("%Lf %d", linfinite, fetestexcept(FE_ALL_EXCEPT));
    feclearexcept(FE_DIVBYZERO);
    volatile double more = huge * huge;
    SAY("%f %d", more, !!fetestexcept(FE_OVERFLOW));
    SAY("%d", fegetexcept());
}

static void trial(void)
{
    roundings();
    flags();
    each_of_one();
    others();
    each_of_two();
}
