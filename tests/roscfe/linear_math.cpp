// Prints what LinearMath makes of numbers on the standard input: a line for each function, in C's hexadecimal form.
// Compiled with -DNS=tf or tf2, against the headers of cfepy or those of a real ROS.
#include <cstdio>
#include <initializer_list>

#if defined(OF_TF)
#include "tf/LinearMath/Transform.h"
#define NS tf
#define F(name) tf##name
#else
#include "tf2/LinearMath/Transform.h"
#define NS tf2
#define F(name) tf2##name
#endif

using namespace NS;

static void put(double x) { std::printf(" %a", x); }
static void put(const Vector3 &v) { put(v.x()), put(v.y()), put(v.z()); }
static void put(const Quaternion &q) { put(q.x()), put(q.y()), put(q.z()), put(q.w()); }
static void put(const Matrix3x3 &m) { put(m[0]), put(m[1]), put(m[2]); }
static void put(const Transform &t) { put(t.getBasis()), put(t.getOrigin()); }

template <class... T>
static void line(const char *name, const T &...values)
{
    std::printf("%s:", name);
    (put(values), ...);
    std::printf("\n");
}

static void vectors(const Vector3 &a, const Vector3 &b, const Vector3 &c, double t)
{
    line("v add", a + b, a - b, a * b, a / b, -a);
    line("v scale", a * t, t * a, a / t);
    line("v cross", a.cross(b), F(Cross)(b, a), a.triple(b, c), F(Triple)(c, b, a));
    line("v numbers", a.dot(b), a.length(), a.length2(), a.distance(b), a.distance2(b), a.angle(b), F(Angle)(b, c));
    line("v axes", a.minAxis(), a.maxAxis(), a.furthestAxis(), a.closestAxis());
    line("v normal", a.normalized(), Vector3(b).normalize(), a.absolute());
    line("v rotate", a.rotate(b.normalized(), t));
    Vector3 between, larger(a), smaller(a), sum(a), difference(a), scaled(a), product(a), divided(a);
    between.setInterpolate3(a, b, t);
    larger.setMax(b);
    smaller.setMin(b);
    line("v lerp", a.lerp(b, t), lerp(b, c, t), between, larger, smaller);
    line("v assign", sum += b, difference -= b, scaled *= t, product *= b, divided /= t);
    Vector3 s0, s1, s2, p, q;
    a.getSkewSymmetricMatrix(&s0, &s1, &s2);
    line("v skew", s0, s1, s2);
    F(PlaneSpace1)(a.normalized(), p, q);
    line("v plane", p, q);
    Vector3FloatData few;
    a.serializeFloat(few);
    s0.deSerializeFloat(few);
    line("v float", s0, a.isZero(), a.fuzzyZero(), a == b, a != b);
}

static void quaternions(const Quaternion &p, const Quaternion &q, const Vector3 &a, const Vector3 &b, const Vector3 &angles,
                        double t)
{
    Quaternion made, euler;
    made.setRPY(angles.x(), angles.y(), angles.z());
    euler.setEuler(angles.x(), angles.y(), angles.z());
    line("q made", made, euler, Quaternion(a, t));
    line("q product", p * q, p * a, a * p, p + q, p - q, p * t, p / t);
    Quaternion sum(p), difference(p), product(p), scaled(p), divided(p);
    line("q assign", sum += q, difference -= q, product *= q, scaled *= t, divided /= t);
    line("q numbers", p.dot(q), p.length(), p.length2(), p.angle(q), p.angleShortestPath(q), made.getAngle(),
         made.getAngleShortestPath(), dot(p, q), length(q), angle(q, p));
    line("q axis", made.getAxis(), Quaternion(0, 0, 0, 1).getAxis());
    line("q near", p.nearest(q), p.farthest(q), p.inverse(), inverse(q), p.normalized(), Quaternion(q).normalize());
    line("q slerp", p.slerp(q, t), slerp(p, q * -1.0, t), p.slerp(p, t));
    line("q rotate", quatRotate(p, a));
    Vector3 v(a), w(b);
    line("q arc", shortestArcQuat(a.normalized(), b.normalized()), shortestArcQuat(a.normalized(), -a.normalized()),
         shortestArcQuatNormalize2(v, w), v, w);
}

static void matrices(const Matrix3x3 &g, const Quaternion &p, const Vector3 &a, const Vector3 &angles)
{
    const Matrix3x3 m(p);
    Matrix3x3       turned, product(g);
    turned.setRPY(angles.x(), angles.y(), angles.z());
    line("m made", m, turned);
    line("m product", m * g, g * a, a * g, product *= m, g.transposeTimes(m), g.timesTranspose(m), g.scaled(a));
    line("m derived", g.transpose(), g.adjoint(), g.absolute());
    line("m inverse", g.inverse());
    line("m numbers", g.determinant(), g.cofac(0, 1, 2, 0), g.tdotx(a), g.tdoty(a), g.tdotz(a));
    line("m parts", g.getRow(1), g.getColumn(2), g == m);
    for (const Matrix3x3 &each : {m, turned})
    {
        double     roll, pitch, yaw, roll2, pitch2, yaw2;
        Quaternion rotation;
        each.getRPY(roll, pitch, yaw);
        each.getEulerYPR(yaw2, pitch2, roll2, 2);
        each.getRotation(rotation);
        line("m angles", roll, pitch, yaw, roll2, pitch2, yaw2);
        line("m rotation", rotation);
    }
    Matrix3x3 locked(0, 0.6, -0.8, 0, 0.8, 0.6, -1, 0, 0), up(0, 0.6, 0.8, 0, 0.8, -0.6, 1, 0, 0);
    double    r, y, z, r2, y2, z2;
    locked.getRPY(r, y, z);
    up.getRPY(r2, y2, z2);
    line("m locked", r, y, z, r2, y2, z2);
}

static void diagonals(const Matrix3x3 &g)
{
    for (double threshold : {1e-6, 0.4})
    {
        Matrix3x3 symmetric(g[0][0], g[0][1], g[0][2], g[0][1], g[1][1], g[1][2], g[0][2], g[1][2], g[2][2]), turned;
        symmetric.diagonalize(turned, threshold, 20);
        line("m diagonal", symmetric, turned);
    }
}

static void transforms(const Quaternion &p, const Quaternion &q, const Vector3 &a, const Vector3 &b)
{
    const Transform first(p, a), second(q, b);
    Transform       product(first), multiplied, read;
    double          cells[16];
    multiplied.mult(first, second);
    first.getOpenGLMatrix(cells);
    read.setFromOpenGLMatrix(cells);
    line("t product", first * second, product *= second, multiplied, first * b, first(b), first * q);
    line("t back", first.inverse(), first.inverseTimes(second), first.invXform(b), first.getRotation());
    line("t opengl", read, read == first);
    for (double cell : cells)
        line("t cell", cell);
}

static void scalars(double x, double y)
{
    line("s angles", F(Acos)(x), F(Asin)(x), F(Atan2Fast)(y, x), F(NormalizeAngle)(x), F(Radians)(x), F(Degrees)(x));
    line("s choose", F(Fsel)(x, y, 2), F(FuzzyZero)(x), F(Equal)(x, y), F(GreaterEqual)(x, y), F(IsNegative)(x));
    line("s root", F(RecipSqrt)(y * y + 1), F(SwapEndianFloat)(float(x)), F(SwapEndian)(0x01020304u), F(Fabs)(x));
}

int main()
{
    double n[32];
    for (;;)
    {
        for (double &each : n)
            if (std::scanf("%la", &each) != 1)
                return 0;
        const Vector3    a(n[0], n[1], n[2]), b(n[3], n[4], n[5]), c(n[6], n[7], n[8]), angles(n[9], n[10], n[11]);
        const Quaternion p(n[12], n[13], n[14], n[15]), q(n[16], n[17], n[18], n[19]);
        const Matrix3x3  g(n[20], n[21], n[22], n[23], n[24], n[25], n[26], n[27], n[28]);
        vectors(a, b, c, n[29]);
        quaternions(p, q, a, b, angles, n[29]);
        matrices(g, p, a, angles);
        diagonals(g);
        transforms(p, q, a, b);
        scalars(n[30], n[31]);
    }
}
