"""Writes packed_by_*.h5, two_runs.xlsx, one_run.xls and pair_with_name_and_unit.mat: h5py 3, hdf5plugin, openpyxl, xlwt, scipy."""
import h5py
import hdf5plugin
import numpy as np
from scipy.io import savemat
n=50
w=np.sin(2*np.pi*12.6*np.arange(n)/2000.0)
t=np.arange(n)/2000.0
with h5py.File('packed_by_plugins.h5','w') as f:
    for name,kw in [('zstd',hdf5plugin.Zstd()),('lz4',hdf5plugin.LZ4()),('blosc',hdf5plugin.Blosc(cname='zstd')),('blosc_lz4',hdf5plugin.Blosc(cname='lz4')),('bitshuffle',hdf5plugin.Bitshuffle()),('bzip2',hdf5plugin.BZip2())]:
        g=f.create_group(name)
        g.attrs['sample_rate_hz']=2000.0
        g.create_dataset('x',data=w,chunks=(25,),**kw)
        g.create_dataset('y',data=2*w)
with h5py.File('packed_by_zfp.h5','w') as f:
    g=f.create_group('run'); g.attrs['sample_rate_hz']=2000.0
    g.create_dataset('x',data=w,chunks=(25,),**hdf5plugin.Zfp(reversible=True))
    g.create_dataset('y',data=2*w)
import openpyxl
wb=openpyxl.Workbook(); s=wb.active; s.title='Run 1'
s.append(['Time (s)','Position (mm)','note'])
for i in range(n): s.append([float(t[i]),float(w[i]), 'start' if i==0 else None])
s2=wb.create_sheet('Run 2'); s2['B2']='Time (s)'; s2['C2']='Velocity (m/s)'
for i in range(n): s2.cell(row=3+i,column=2,value=float(t[i])); s2.cell(row=3+i,column=3,value=float(2*w[i]))
s3=wb.create_sheet('Notes'); s3['A1']='measured by hand'
wb.save('two_runs.xlsx')
import xlwt
b=xlwt.Workbook(); s=b.add_sheet('Run 1')
for c,h in enumerate(['Time (s)','Position (mm)']): s.write(0,c,h)
for i in range(n): s.write(1+i,0,float(t[i])); s.write(1+i,1,float(w[i]))
b.save('one_run.xls')
savemat('pair_with_name_and_unit.mat',{'X':np.column_stack([t,w]),'Unit':'m/s','ChanName':'Laser'})
