# Style of all figures. The colors of Okabe and Ito are distinguishable with every kind of color blindness.
set encoding utf8
ink = '#24292f'; grey = '#6b7280'; pale = '#e5e7eb'
blue = '#0072b2'; vermilion = '#d55e00'; green = '#009e73'; purple = '#cc79a7'; orange = '#e69f00'; sky = '#56b4e9'
set border 3 linecolor rgb grey linewidth 1
set tics nomirror out scale 0.6 textcolor rgb ink
set grid linecolor rgb pale linewidth 0.8 linetype 1
