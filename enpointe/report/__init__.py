"""The report: a dance as one HTML page with its stave, pictures, film and figures."""

from enpointe.report.writing import ReportFiles as ReportFiles
from enpointe.report.writing import write_report as write_report
