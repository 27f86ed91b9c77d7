"""Writes one log by the libraries of its own format: write_logs.py KIND FILE [COMPRESSION [RECORDING]].

Row k of 500, 500 Hz: force (0.1 k, -0.25, 1000 + k) N, torque (1e-3 k, 0, 2), position
(1e-3 k, 0.5, -0.25) m, orientation (w, x, y, z) = (0.8, 0, 0, 0.6). Stamps begin at 1600000000.5 s,
poses 1 ms later than forces; messages are received 0.1 s after their stamp.
With RECORDING, a CSV of this project with Euler angles, its rows are written instead, all at one time.
Exit 77: a library is missing.
"""
import math
import sqlite3
import struct
import sys

ROWS = 500
START = 1600000000_500000000  # ns
table = None


def stamp(k, late=0):
    return START + 2_000_000 * k + late


def force(k):
    return (0.1 * k, -0.25, 1000.0 + k, 1e-3 * k, 0.0, 2.0)


def pose(k):
    return (1e-3 * k, 0.5, -0.25, 0.0, 0.0, 0.6, 0.8)  # x y z, qx qy qz qw


def take_rows_of(path):
    """Replaces the numbers above by those of a recording."""
    with open(path) as file:
        names = file.readline().strip().split(",")
        rows = [dict(zip(names, map(float, line.split(",")))) for line in file]

    def forces(k):
        return tuple(rows[k][name] for name in ("fx", "fy", "fz", "tx", "ty", "tz"))

    def poses(k):
        row = rows[k]
        (ca, sa), (cb, sb), (cc, sc) = ((math.cos(row[n] / 2), math.sin(row[n] / 2))
                                        for n in ("alpha", "beta", "gamma"))
        turn = (ca * cb * sc - sa * sb * cc, ca * sb * cc + sa * cb * sc,
                sa * cb * cc - ca * sb * sc, ca * cb * cc + sa * sb * sc)
        return (row["x"], row["y"], row["z"]) + turn

    globals().update(ROWS=len(rows), force=forces, pose=poses, START=1600000000_000000000,
                     stamp=lambda k, late=0: 1600000000_000000000 + round(1e9 * rows[k]["t"]),
                     table=rows)


def write_csv(path, _):
    """What a foreign program exports: semicolons, decimal commas, ms, mm, degrees."""
    columns = [("Time [ms]", "t", 1e3), ("Fx [N]", "fx", 1), ("Fy [N]", "fy", 1),
               ("Fz [N]", "fz", 1), ("Mx [Nm]", "tx", 1), ("My [Nm]", "ty", 1), ("Mz [Nm]", "tz", 1),
               ("X [mm]", "x", 1e3), ("Y [mm]", "y", 1e3), ("Z [mm]", "z", 1e3),
               ("Yaw [deg]", "alpha", 180 / math.pi), ("Pitch [deg]", "beta", 180 / math.pi),
               ("Roll [deg]", "gamma", 180 / math.pi)]
    with open(path, "w", encoding="utf-8-sig") as file:
        file.write("% exported by another program\n" + ";".join(c[0] for c in columns) + ";\n")
        for row in table:
            cells = [repr(row[name] * factor) for _, name, factor in columns]
            file.write(";".join(cells).replace(".", ",") + ";\n")


def write_bag(path, compression):
    import genpy
    import rosbag
    from geometry_msgs.msg import PoseStamped, WrenchStamped
    from sensor_msgs.msg import JointState

    def time(ns):
        return genpy.Time(ns // 10**9, ns % 10**9)

    bag = rosbag.Bag(path, "w", compression=compression, chunk_threshold=20000)
    for k in range(ROWS):
        wrench = WrenchStamped()
        wrench.header.stamp = time(stamp(k))
        wrench.header.frame_id = "ft_sensor"
        f, t = wrench.wrench.force, wrench.wrench.torque
        f.x, f.y, f.z, t.x, t.y, t.z = force(k)
        bag.write("/ft/wrench", wrench, time(stamp(k, 100_000_000)))
        tool = PoseStamped()
        tool.header.stamp = time(stamp(k, 1_000_000))
        tool.header.frame_id = "base"
        p, q = tool.pose.position, tool.pose.orientation
        p.x, p.y, p.z, q.x, q.y, q.z, q.w = pose(k)
        bag.write("/tool/pose", tool, time(stamp(k, 101_000_000)))
        if k % 5 == 0:
            joints = JointState()
            joints.header.stamp = time(stamp(k))
            joints.name = ["shoulder", "elbow"]
            joints.position = [0.01 * k, -0.02 * k]
            joints.effort = [1.0, 2.0]
            bag.write("/joint_states", joints, time(stamp(k)))
    bag.close()


class Cdr:
    """Little-endian XCDR1."""

    def __init__(self):
        self.bytes = b""

    def add(self, code, value):
        size = struct.calcsize(code)
        self.bytes += b"\0" * (-len(self.bytes) % size) + struct.pack("<" + code, value)
        return self

    def text(self, value):
        self.add("I", len(value) + 1)
        self.bytes += value.encode() + b"\0"
        return self

    def header(self, ns, frame):
        return self.add("i", ns // 10**9).add("I", ns % 10**9).text(frame)

    def doubles(self, values):
        for value in values:
            self.add("d", value)
        return self

    def done(self):
        return b"\0\1\0\0" + self.bytes


def write_db3(path, _):
    db = sqlite3.connect(path)
    db.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
               "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    db.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
               "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    db.execute("INSERT INTO topics VALUES(1,'/ft/wrench','geometry_msgs/msg/WrenchStamped','cdr','')")
    db.execute("INSERT INTO topics VALUES(2,'/tf','tf2_msgs/msg/TFMessage','cdr','')")
    db.execute("INSERT INTO topics VALUES(3,'/odd','odd_msgs/msg/Odd','cdr','')")
    for k in range(ROWS):
        data = Cdr().header(stamp(k), "ft_sensor").doubles(force(k)).done()
        db.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(1,?,?)",
                   (stamp(k, 100_000_000), data))
        tf = Cdr().add("I", 2)
        tf.header(stamp(k, 1_000_000), "base").text("tool").doubles(pose(k))
        tf.header(stamp(k), "base").text("camera").doubles((9, 9, 9, 0, 0, 0, 1))
        db.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(2,?,?)",
                   (stamp(k, 101_000_000), tf.done()))
    db.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(3,1,?)", (b"\0\1\0\0\7",))
    db.commit()
    db.close()


WRENCH = """std_msgs/Header header
geometry_msgs/Wrench wrench
"""
PARTS = """
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3  force
geometry_msgs/Vector3  torque  # N m
MSG: geometry_msgs/Vector3
float64 x 0
float64 y 0
float64 z 0
MSG: geometry_msgs/Pose
Point position
Quaternion orientation
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
"""
ODD = """uint8 KIND=3
string<=20 label
bool[] flags
int16 small
float32[<=4] few
odd_msgs/Inner[2] inner
uint8[] image
int64 last
MSG: odd_msgs/Inner
int8 a
float64 b
"""


def definition(text):
    return text.replace("MSG:", "=" * 80 + "\nMSG:").encode()


def prefixed(data):
    return struct.pack("<I", len(data)) + data


def odd(k):
    cdr = Cdr().text("x" * (k % 3)).add("I", 3).add("?", 1).add("?", 0).add("?", 1).add("h", -k)
    cdr.add("I", 2).add("f", 0.5).add("f", k).add("b", -1).add("d", 0.1).add("b", 5).add("d", k)
    cdr.add("I", 1000)
    cdr.bytes += b"i" * 1000
    return cdr.add("q", -(10**12)).done()


def compressed(kind, data):
    if kind == "lz4":
        import roslz4
        return roslz4.compress(data)
    if kind == "zstd":
        import ctypes
        try:
            zstd = ctypes.CDLL("libzstd.so.1")
        except OSError as error:
            raise ImportError(error)
        out = ctypes.create_string_buffer(len(data) + 4096)
        size = zstd.ZSTD_compress(out, len(out), data, len(data), 3)
        return out.raw[:size]
    return data


def write_mcap(path, compression):
    import zlib

    def record(opcode, content):
        return struct.pack("<BQ", opcode, len(content)) + content

    def message(channel, ns, data):
        return record(5, struct.pack("<HIQQ", channel, 0, ns, ns) + data)

    def schema(index, name, text):
        return record(3, struct.pack("<H", index) + prefixed(name) + prefixed(b"ros2msg")
                      + prefixed(definition(text)))

    def channel(index, topic):
        return record(4, struct.pack("<HH", index, index) + prefixed(topic) + prefixed(b"cdr")
                      + struct.pack("<I", 0))

    def chunk(records):
        packed = compressed(compression, records)
        kind = b"" if compression == "none" else compression.encode()
        return record(6, struct.pack("<QQQI", 0, 0, len(records), zlib.crc32(records))
                      + prefixed(kind) + struct.pack("<Q", len(packed)) + packed)

    with open(path, "wb") as file:
        file.write(b"\x89MCAP0\r\n" + record(1, prefixed(b"ros2") + prefixed(b"test")))
        head = schema(1, b"geometry_msgs/msg/WrenchStamped", WRENCH + PARTS) + channel(1, b"/ft/wrench")
        head += schema(2, b"geometry_msgs/msg/PoseStamped",
                       "std_msgs/Header header\nPose pose" + PARTS) + channel(2, b"/tool/pose")
        head += schema(3, b"odd_msgs/msg/Odd", ODD) + channel(3, b"/odd")
        records = head
        for k in range(ROWS):
            wrench = Cdr().header(stamp(k), "ft_sensor").doubles(force(k)).done()
            records += message(1, stamp(k, 100_000_000), wrench)
            tool = Cdr().header(stamp(k, 1_000_000), "base").doubles(pose(k)).done()
            records += message(2, stamp(k, 101_000_000), tool)
            if not table:
                records += message(3, stamp(k), odd(k))
            if k % 100 == 99 or k == ROWS - 1:
                file.write(chunk(records) + record(7, b"\1\0" + struct.pack("<I", 0)))
                records = b""
        file.write(record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)))
        file.write(b"\x89MCAP0\r\n")


def arrays():
    import numpy
    rows = range(ROWS)
    quaternion = [(pose(k)[6],) + pose(k)[3:6] for k in rows]
    return {"t": numpy.array([1e-9 * (stamp(k) - START) for k in rows]),
            "force": numpy.array([force(k)[:3] for k in rows]),
            "torque": numpy.array([force(k)[3:] for k in rows]),
            "position": numpy.array([pose(k)[:3] for k in rows]),
            "orientation": numpy.array(quaternion)}


def matrices():
    """Poses as homogeneous matrices, N x 4 x 4."""
    import numpy
    data = arrays()
    made = numpy.zeros((ROWS, 4, 4))
    for k in range(ROWS):
        x, y, z, w = pose(k)[3:7]
        made[k, :3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                           [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                           [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        made[k, :3, 3] = pose(k)[:3]
        made[k, 3, 3] = 1
    return {"t": data["t"], "force": data["force"], "T_base_tool": made}


def write_matrices_npz(path, _):
    import numpy
    numpy.savez(path, **matrices())


def write_matrices_mat(path, _):
    import scipy.io
    data = matrices()
    data["T_base_tool"] = data["T_base_tool"].transpose(1, 2, 0)
    scipy.io.savemat(path, data)


def write_npz(path, compression):
    import numpy
    data = arrays()
    data["force"] = numpy.asfortranarray(data["force"])
    data["position"] = data["position"].astype(">f8")
    data["label"] = numpy.array(["a", "b"])
    (numpy.savez_compressed if compression == "deflate" else numpy.savez)(path, **data)


def write_mat(path, compression):
    import scipy.io
    data = arrays()
    data["log"] = {"force": data.pop("force"), "torque": data.pop("torque").T}
    scipy.io.savemat(path, data, do_compression=compression == "deflate")


def write_mat4(path, _):
    import scipy.io
    scipy.io.savemat(path, arrays(), format="4")


def write_cells_mat(path, _):
    import numpy
    import scipy.io
    cells = numpy.empty((1, 2), dtype=object)
    for k in range(2):
        t = 1e-3 * numpy.arange(100 + 50 * k)
        cells[0, k] = numpy.stack([t, numpy.sin(t), 10.0 * k + t])
    scipy.io.savemat(path, {"swing": cells})


def write_mat73(path, _):
    import h5py
    import numpy
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in arrays().items():
            data = file.create_dataset(name, data=numpy.atleast_2d(values).T if values.ndim > 1
                                       else values.reshape(1, -1), compression="gzip")
            # As MATLAB does: a string that ends by NUL, in six bytes.
            kind = h5py.h5t.C_S1.copy()
            kind.set_size(6)
            kind.set_strpad(h5py.h5t.STR_NULLTERM)
            space = h5py.h5s.create(h5py.h5s.SCALAR)
            attribute = h5py.h5a.create(data.id, b"MATLAB_class", kind, space)
            attribute.write(numpy.array(b"double", dtype="S6"), mtype=kind)
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + b"\0" * 8 + b"\0\2IM"
    with open(path, "r+b") as file:
        file.write(head)


if __name__ == "__main__":
    try:
        if len(sys.argv) > 4:
            take_rows_of(sys.argv[4])
        globals()["write_" + sys.argv[1]](sys.argv[2], (sys.argv + ["none"])[3])
    except ImportError as missing:
        print(missing, file=sys.stderr)
        sys.exit(77)
