"""The external force from Python by ctypes, with numpy arrays: the same as predict.c.
   python3 predict.py libdcnn.so.0 sim.json < samples.txt"""
import ctypes
import sys

import numpy as np

library, model = ctypes.CDLL(sys.argv[1]), sys.argv[2]
array = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
library.dcnn_open.restype = ctypes.c_void_p
library.dcnn_open.argtypes = [ctypes.c_char_p] * 4 + [ctypes.c_size_t]
library.dcnn_step.argtypes = [ctypes.c_void_p, ctypes.c_double] + [array] * 5
library.dcnn_state_name.restype = ctypes.c_char_p
library.dcnn_close.argtypes = [ctypes.c_void_p]

error = ctypes.create_string_buffer(256)
tool = library.dcnn_open(model.encode(), None, None, error, len(error))
if not tool:
    sys.exit("predict.py: " + error.value.decode())
own, external = np.zeros(6), np.zeros(6)
for row in np.loadtxt(sys.stdin, ndmin=2):
    wrench = np.concatenate([row[8:11], np.zeros(3)])
    state = library.dcnn_step(tool, row[0], row[1:4].copy(), row[4:8].copy(), wrench, own, external)
    print("%.9g %s %.9g %.9g %.9g" % (row[0], library.dcnn_state_name(state).decode(), *external[:3]))
library.dcnn_close(tool)
