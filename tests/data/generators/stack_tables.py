"""Header rows of public tools with two dimensions each, their sums and worst cases in decimal arithmetic.

    python3 tests/data/generators/stack_tables.py > tests/data/stack-tables/headers.json

Header rows are facts of public source files and pages, named in `source`. The two dimensions are made up: A = 10 with deviations
-0.1 and +0.1, B = 4 with -0.02 and +0.05, or with -0.05 and +0.05 where a header has one tolerance only. Nothing here is known of sensitol
but the options that name a column.
"""

import json
from decimal import Decimal as D

SYMMETRIC = [("10", "0.1", "-0.1"), ("4", "0.05", "-0.05")]
UNEQUAL = [("10", "0.1", "-0.1"), ("4", "0.05", "-0.02")]


def gap(rows, signs):
    """Nominal, least and greatest sum of the rows with their signs."""
    nominal = sum(s * D(n) for (n, _, _), s in zip(rows, signs))
    ends = [sorted([s * (D(n) + D(u)), s * (D(n) + D(l))]) for (n, u, l), s in zip(rows, signs)]
    return float(nominal), [float(sum(end[0] for end in ends)), float(sum(end[1] for end in ends))]


def case(source, table, rows, signs, unit=None, way_out=(), refused=None):
    nominal, worst = gap(rows, signs)
    one = {"source": source, "table": table, "gap": nominal, "worst_case": worst}
    one |= {"unit": unit} if unit else {}
    one |= {"refused": refused, "way_out": list(way_out)} if refused else {}
    return one


def refusal(source, table, refused):
    return {"source": source, "table": table, "refused": refused}


def ignore(*headers):
    return [word for header in headers for word in ("--column", f"ignore={header}")]


PLUS, MINUS = [1, 1], [1, -1]
CASES = [
    case("github.com/utku-gaspak/tolerance-stackup-analyser lib/csv.ts",
         "id,label,direction,nominal,plusTolerance,minusTolerance\n1,A,+,10,0.1,0.1\n2,B,-,4,0.05,0.02\n", UNEQUAL, MINUS),
    case("Python stack-up calculator, test of read_components",
         "component,nominal_mm,tolerance_mm,direction\nA,10,0.1,1\nB,4,0.05,-1\n", SYMMETRIC, MINUS, "mm"),
    case("stack-up page, section CSV Format of its README", "feature,nominal,tolerance,direction\nA,10,0.1,1\nB,4,0.05,-1\n",
         SYMMETRIC, MINUS),
    case("browser tool, parseCSV of dimensions", "name,nominal,tol,distribution\nA,10,0.1,normal\nB,4,0.05,uniform\n", SYMMETRIC, PLUS),
    case("quality system, bulk import of measurements",
         "name,nominal,upper_tol,lower_tol,unit,required\nA,10.000,0.100,-0.100,mm,true\nB,4.000,0.050,-0.020,mm,true\n",
         UNEQUAL, PLUS, "mm"),
    case("shop-floor tracker, import of measurement definitions",
         "step,label,type,unit,nominal,upper_tol,lower_tol,default_equipment,backup_equipment\n"
         "Pump > Tap,A,NUMERIC,mm,10,0.1,0.1,SN-100,Caliper\nPump > Bore,B,NUMERIC,mm,4,0.05,0.02,SN-100,Caliper\n",
         UNEQUAL, PLUS, "mm"),
    case("command-line stack-up script, columns of its CSV",
         "name,nominal,plus,minus,dir,dist,sensitivity,mean_shift\nA,10,0.1,-0.1,+,normal,1,0\nB,4,0.05,-0.02,-,normal,1,0\n",
         UNEQUAL, MINUS, None, ignore("mean_shift"), "`mean_shift`"),
    case("waveguide project, critical_chars.csv",
         "char_id,feature,nominal,tol_plus,tol_minus,datum,source_var,meas_method,inspect_pct\n"
         "CH-001,A,10,0.1,0.1,A,a,CMM,100\nCH-002,B,4,0.05,0.02,A,b,CMM,100\n",
         UNEQUAL, PLUS, None, ignore("inspect_pct"), "`inspect_pct`"),
    case("inspection planner, import of part dimensions",
         "part_id,part_name,op_number,op_label,dimension_name,nominal,tol_plus,tol_minus,unit,sampling,sampling_interval,input_mode,tool_it_nums\n"
         "1234,Body,010,Turn,A,10,0.1,0.1,in,custom,3,single,IT-0042\n1234,Body,020,Bore,B,4,0.05,0.02,in,custom,3,single,IT-0042\n",
         UNEQUAL, PLUS, "in", ignore("part_id", "sampling_interval"), "`part_id`, `sampling_interval`"),
    case("CAD viewer, inspection export in C++",
         "item,type,nominal,plus,minus,actual,pass,note\nA,LINEAR,10,0.1,0.1,10.02,PASS,\nB,LINEAR,4,0.05,0.02,4.01,PASS,\n",
         UNEQUAL, PLUS, None, ignore("actual"), "`actual`"),
    case("inspection database, template of dimensions",
         "BalloonNumber,Code,Description,Nominal,TolPlus,TolMinus,Unit,Category\n1,A,bore,10,0.1,0.1,mm,x\n2,B,pin,4,0.05,0.02,mm,x\n",
         UNEQUAL, PLUS, "mm"),
    case("camera measurement program, CSV export",
         "ID,Tool,Value (mm / °),Value (px),Unit,Nominal,Upper Tol (+),Lower Tol (-),Status,Details\n"
         "A,Line,10.01,512.2,mm,10,0.1,-0.1,OK,\nB,Line,4.01,205.1,mm,4,0.05,-0.02,OK,\n",
         UNEQUAL, PLUS, "mm", ignore("Value (mm / °)", "Value (px)"), "`Value (mm / °)`, `Value (px)`"),
    case("capability study of a coordinate machine, CSV export",
         "Feature Name,Feature Type,Nominal,Upper Tolerance,Lower Tolerance,Actual,Deviation\n"
         "A,Length,10,0.1,-0.1,10.02,0.02\nB,Length,4,0.05,-0.02,4.01,0.01\n",
         UNEQUAL, PLUS, None, ignore("Actual", "Deviation"), "`Actual`, `Deviation`"),
    case("aircraft data package, tolerance-stackup-template.csv",
         "Stack ID,Feature / Requirement,Chain Path,Nominal,Upper Tol,Lower Tol,Method (Worst/RSS),Cpk Target,Contributors,Margin,Notes\n"
         "TSU-1,A,FS->RIB,10,0.1,-0.1,RSS,1.33,drill,,\nTSU-2,B,RIB->SKIN,4,0.05,-0.02,RSS,1.33,drill,,\n",
         UNEQUAL, PLUS, None, ["--column", "name=Feature / Requirement", *ignore("Cpk Target")], "`Cpk Target`"),
    case("process control page, template of limits", "label,nominal,usl,lsl\nA,10,10.1,9.9\nB,4,4.05,3.98\n", UNEQUAL, PLUS),
    case("quality database of drawings",
         "component,feature,nominal,usl,lsl,unit,revision,notes\nring,A,10,10.1,9.9,mm,C,\nring,B,4,4.05,3.98,mm,C,\n",
         UNEQUAL, PLUS, "mm"),
    case("vision system, import of measurement points",
         "pointCode,type,x,y,w,h,nominal,usl,lsl,unit,algorithm\nA,edge,1,2,3,4,10,10.1,9.9,mm,match\nB,edge,1,2,3,4,4,4.05,3.98,mm,match\n",
         UNEQUAL, PLUS, "mm", ["--column", "name=pointCode", *ignore("x", "y", "w", "h")], "no row names the columns"),
    case("tolanalysis.com, table of features",
         "#,From,To,Mfg Process,Nominal (mm),+ Tol (mm),\u2212 Tol (mm),Dir\n1,A,B,mill,10,0.1,0.1,+\n2,B,C,mill,4,0.05,0.02,-\n",
         UNEQUAL, MINUS, "mm", ["--column", "name=From"], "no row names the columns"),
    case("page on a calculator in a spreadsheet",
         "Part,Nom,Upper,Lower,Mean,Half-tol,Direction,Contrib (mean×dir),Tol WC,Tol RSS²\n"
         "A,10,10.1,9.9,10.0,0.1,+,10.0,0.1,0.01\nB,4,4.05,3.95,4.0,0.05,-,-4.0,0.05,0.0025\n",
         SYMMETRIC, MINUS, None, ignore("Contrib (mean×dir)", "Tol WC", "Tol RSS²"), "`Tol WC`"),
    case("i.rad.cm/library/templates/tolerance-analysis",
         "ID,Description,P/N,Revision,Type,a,Nom,T1,T2,Lower,Center,Upper,Shift,Tol,Tol^2,%,Notes/Source\n"
         "1,A,100,A,sym,1,10,0.1,,9.9,10,10.1,0,0.1,0.01,80,\n2,B,101,A,sym,-1,4,0.05,,3.95,4,4.05,0,0.05,0.0025,20,\n",
         SYMMETRIC, MINUS, None, ignore("T1", "T2"), "`T1`"),
    case("drawing reader in German and English",
         "Nr;Art;Anforderung;Nennmaß;Oberes Abmaß;Unteres Abmaß;Obere Grenze;Untere Grenze;Einheit\n"
         "1;length;A;10;+0,1;-0,1;10,1;9,9;mm\n2;length;B;4;+0,05;-0,02;4,05;3,98;mm\n", UNEQUAL, PLUS, "mm"),
    case("reader of inspection plans, synonyms of headers", "Merkmal;Nennmaß;O-Tol;U-Tol\nA;10;0,1;-0,1\nB;4;0,05;-0,02\n", UNEQUAL, PLUS),
    case("extraction service, test of CSV input",
         "characteristic_id,nominal,upper_tolerance,lower_tolerance,unit\nA,10,0.1,-0.1,mm\nB,4,0.05,-0.02,mm\n", UNEQUAL, PLUS, "mm"),
    refusal("github.com/aevyrie/tolstack, JSON input",
            '{"params": {"part_sigma": 3.0}, "tolerance_loop": [{"Linear": {"distance": {"dim": 10, "tol_pos": 0.1, "tol_neg": 0.1, "sigma": 3.0}}}]}',
            "no row names the columns"),
    case("github.com/AhmedNjar/TolerenceStackupStudio schemas/component.schema.json",
         '[{"id": "A", "label": "A", "kind": "LINEAR", "nominal": 10, "upperTol": 0.1, "lowerTol": 0.1, "distribution": "NORMAL_3S"},'
         ' {"id": "B", "label": "B", "kind": "LINEAR", "nominal": 4, "upperTol": 0.05, "lowerTol": 0.02, "distribution": "UNIFORM"}]',
         UNEQUAL, PLUS),
    case("browser tool, interface Dimension",
         '{"dimensions": [{"id": "x1", "name": "A", "nominal": 10, "tolPlus": 0.1, "tolMinus": 0.1, "sign": 1, "distribution": "Normal",'
         ' "cpk": 1.33, "type": "Linear"}, {"id": "x2", "name": "B", "nominal": 4, "tolPlus": 0.05, "tolMinus": 0.02, "sign": -1,'
         ' "distribution": "Normal", "cpk": 1.33, "type": "Linear"}]}', UNEQUAL, MINUS),
    case("CAD assistant, tolerance_stackup(chain=...)",
         '{"chain": [{"name": "A", "nominal": 10, "plus": 0.1, "minus": 0.1}, {"name": "B", "nominal": 4, "plus": 0.05, "minus": 0.02}]}',
         UNEQUAL, PLUS),
    refusal("stack-up server, rows of its request",
            '{"loop_name": "golden", "rows": [{"nominal": 10, "upper": 0.1, "lower": -0.1}]}', "no row names the columns"),
    case("engineering cards, links of a tolerance chain",
         '{"links": [{"name": "A", "nominal": 10, "tolerance": 0.1, "direction": "+"}, {"name": "B", "nominal": 4, "tolerance": 0.05,'
         ' "direction": "-"}]}', SYMMETRIC, MINUS),
    case("process database, sample of measurements",
         "Machine,Unit,Item,Measured At,Value,Nominal,USL,LSL\nM1,U1,A,2026-01-05 08:00:00,10.1,10,10.1,9.9\n"
         "M1,U1,B,2026-01-05 08:00:00,4.01,4,4.05,3.98\n", UNEQUAL, PLUS, None, ignore("Value", "Unit"), "`Value`"),
    case("drawing editor, lines of manual measurements",
         "key,nominal_mm,tol_plus_mm,tol_minus_mm,measured_mm\nA,10,0.1,0.1,10.01\nB,4,0.05,0.02,4.01\n",
         UNEQUAL, PLUS, "mm", ignore("measured_mm"), "`measured_mm`"),
    refusal("stack form of a training course",
            "STEP ID,DESCRIPTION,FROM / TO,POSITIVE NOMINAL,NEGATIVE NOMINAL,ONE HALF COMPONENT TOLERANCE\n1,A,a-b,10,,0.1\n",
            "no row names the columns"),
]

if __name__ == "__main__":
    print(json.dumps({"cases": CASES}, indent=1, ensure_ascii=False))
